// How far a parameter may go: the list of searches, a place to begin one, and the view of one.
import { listSearches, submitSearch } from "/core/api.js";
import { h } from "/core/dom.js";
import { exact, moment, nameOf, titleOf, unitOf } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { showLimits } from "/study/limit_view.js";

const pollMs = 4000;

// What the flexible linkage of the paper may bear.
const example = {
  name: "How large may the clearance become?",
  parameters: { coupler: "flexible", duration_s: 3 },
  over: { clearance_mm: { from: 0.05, to: 0.5, tolerance: 0.02 } },
  metric: "amplification",
  bound: 20,
  quantile: 0.9,
  sweep: { crank_velocity_rad_s: [5, 8, 10] },
  replicates: { count: 8 },
};

export async function show(main, { id, signal }) {
  if (id) return showLimits(main, id, signal);
  document.title = "RPSUP: limits";
  const body = h("tbody");
  const headings = ["Name", "State", "Looks for", "Created"];
  const status = h("p", { class: "quiet", role: "status" });
  const table = h("div", { class: "scroll card", tabindex: 0, role: "region", "aria-label": "Searches" },
    h("table", {}, h("thead", {}, h("tr", {}, headings.map((text) => h("th", { scope: "col" }, text)))), body));
  main.replaceChildren(h("h1", {}, "Limits"), h("p", {}, "How far may a parameter go until a metric exceeds its bound?"), status, table, beginning());
  const refresh = async () => {
    try {
      const { items } = await listSearches({ limit: 100 }, signal);
      body.replaceChildren(...items.map(row));
      table.hidden = items.length === 0;
      status.textContent = items.length === 0 ? "No search has been begun yet." : "";
    } catch (error) {
      if (error.name !== "AbortError") status.textContent = `${error.message} Trying again …`;
    }
  };
  await refresh();
  const timer = setInterval(refresh, pollMs);
  signal.addEventListener("abort", () => clearInterval(timer));
}

function row(search) {
  const { id, name, state, parameter, metric, bound } = search;
  const unit = unitOf(metric);
  return h("tr", {}, h("td", { class: "name" }, h("a", { href: routeTo("searches", id) }, name || id)), h("td", { class: state }, state),
    h("td", {}, `${titleOf(parameter)} with ${nameOf(metric).toLowerCase()} up to ${exact(bound)}${unit ? ` ${unit}` : ""}`), h("td", { class: "fixed" }, moment(search.created_at)));
}

/// The request as JSON, with what the service says of it.
function beginning() {
  const area = h("textarea", { rows: 12, class: "wide", spellcheck: "false", value: JSON.stringify(example, null, 1) });
  const trouble = h("div", { class: "trouble", role: "alert" });
  const begin = async (event) => {
    event.preventDefault();
    try {
      location.hash = routeTo("searches", (await submitSearch(JSON.parse(area.value))).id);
    } catch (error) {
      const faults = error.faults ?? [];
      trouble.replaceChildren(faults.length > 0 ? h("ul", {}, faults.map(({ pointer, detail }) => h("li", {}, `${pointer}: ${detail}`))) : h("p", {}, error.message));
    }
  };
  return h("form", { class: "card", onsubmit: begin }, h("h2", {}, "Begin a search"),
    h("label", { class: "choice" }, h("span", {}, "Request, as JSON: over names the parameter and where to look; axes under sweep have a limit for each value"), area),
    trouble, h("p", {}, h("button", { class: "main" }, "Begin")));
}
