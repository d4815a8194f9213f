// How a bearing is worn over the hours: the list of wear studies, a place to begin one, and the view of one.
import { listWearStudies, submitWearStudy } from "/core/api.js";
import { h } from "/core/dom.js";
import { exact, moment } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { showWear } from "/study/wear_view.js";

const pollMs = 4000;

// The paper's rigid linkage until its bearing has got 10 um wider at the deepest place.
const example = { name: "What does wear do?", parameters: { duration_s: 3 }, wear_coefficient_m2_n: 1e-15, worn_clearance_mm: 0.26, max_depth_step_um: 2 };

export async function show(main, { id, signal }) {
  if (id) return showWear(main, id, signal);
  document.title = "RPSUP: wear";
  const body = h("tbody");
  const status = h("p", { class: "quiet", role: "status" });
  const table = h("div", { class: "scroll card", tabindex: 0, role: "region", "aria-label": "Wear studies" },
    h("table", {}, h("thead", {}, h("tr", {}, ["Name", "State", "Until", "Created"].map((text) => h("th", { scope: "col" }, text)))), body));
  main.replaceChildren(h("h1", {}, "Wear"), h("p", {}, "How is the bearing worn by a motion that its own wear changes?"), status, table, beginning());
  const refresh = async () => {
    try {
      const { items } = await listWearStudies({ limit: 100 }, signal);
      body.replaceChildren(...items.map(row));
      table.hidden = items.length === 0;
      status.textContent = items.length === 0 ? "No wear study has been begun yet." : "";
    } catch (error) {
      if (error.name !== "AbortError") status.textContent = `${error.message} Trying again …`;
    }
  };
  await refresh();
  const timer = setInterval(refresh, pollMs);
  signal.addEventListener("abort", () => clearInterval(timer));
}

function row({ id, name, state, hours, worn_clearance_mm: clearance, created_at: created }) {
  const until = [hours === null ? "" : `${exact(hours)} h`, clearance === null ? "" : `${exact(clearance)} mm`].filter(Boolean).join(" or ");
  return h("tr", {}, h("td", { class: "name" }, h("a", { href: routeTo("wear", id) }, name || id)), h("td", { class: state }, state), h("td", {}, until),
    h("td", { class: "fixed" }, moment(created)));
}

/// The request as JSON, with what the service says of it.
function beginning() {
  const area = h("textarea", { rows: 12, class: "wide", spellcheck: "false", value: JSON.stringify(example, null, 1) });
  const trouble = h("div", { class: "trouble", role: "alert" });
  const begin = async (event) => {
    event.preventDefault();
    try {
      location.hash = routeTo("wear", (await submitWearStudy(JSON.parse(area.value))).id);
    } catch (error) {
      const faults = error.faults ?? [];
      trouble.replaceChildren(faults.length > 0 ? h("ul", {}, faults.map(({ pointer, detail }) => h("li", {}, `${pointer}: ${detail}`))) : h("p", {}, error.message));
    }
  };
  return h("form", { class: "card", onsubmit: begin }, h("h2", {}, "Begin a wear study"),
    h("label", { class: "choice" }, h("span", {}, "Request, as JSON: hours, worn_clearance_mm or both say how far; no step wears off more than max_depth_step_um anywhere"), area),
    trouble, h("p", {}, h("button", { class: "main" }, "Begin")));
}
