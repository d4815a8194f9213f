// One search: its limits over the axes, with the evaluations that they stand on.
import { cancelSearch, deleteSearch, findSearch, limitsUrl, retrySearch } from "/core/api.js";
import { loadCharts, saveButtons } from "/core/charts.js";
import { confirmed } from "/core/dialog.js";
import { choice, h, notify } from "/core/dom.js";
import { exact, number, plural, pointOf, titleOf, unitOf } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { limitCurve } from "/study/limit_curve.js";
import { limitPoints } from "/study/limit_points.js";

const pollMs = 1000;
const verdicts = { open: "not known yet", found: "found", never_exceeded: "never exceeded", always_exceeded: "exceeded from the start", lost: "a failed job is in the way" };

export async function showLimits(main, id, signal) {
  loadCharts().catch(() => {});  // told where a chart would be
  const view = new LimitView(await findSearch(id, signal), signal);
  main.replaceChildren(...view.parts());
  await view.start();
}

/// The combination of a limit: "10 rad/s, flexible".
const combinationOf = (search, limit) => search.axes.map((axis) => pointOf(axis, limit[axis])).join(", ");

class LimitView {
  constructor(search, signal) {
    Object.assign(this, { search, signal, shown: 0, charts: [] });
  }

  parts() {
    const { search } = this;
    const name = search.name || search.id;
    document.title = `RPSUP: ${name}`;
    this.status = h("p", { role: "status" });
    this.buttons = h("p", { class: "actions" });
    this.picker = h("span");
    this.body = h("tbody");
    this.curve = h("div", { class: "chart tall" });
    this.points = h("div", { class: "chart tall" });
    const card = (title, element, index, more = "") => h("section", { class: "card" },
      h("div", { class: "head" }, h("h2", {}, title), saveButtons(() => this.charts[index], () => `${name} ${title.toLowerCase()}`)), more, element);
    const columns = [...search.axes.map((axis) => titleOf(axis)), "Verdict", `Limit [${unitOf(search.parameter) || "1"}]`, "All within up to", "None within from", "Evaluations", "Where the metric falls"];
    return [
      h("div", { class: "head" }, h("div", {}, h("h1", {}, name), this.status), this.buttons),
      h("p", {}, `The largest ${titleOf(search.parameter)} for which at least ${number(100 * search.quantile)} % of the replicates keep ${titleOf(search.metric)} at or below ${exact(search.bound)}.`),
      h("div", { class: "columns even" }, card("Limit", this.curve, 0), card("Evaluations", this.points, 1, this.picker)),
      h("section", { class: "card" }, h("h2", {}, "Limits"), h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Limits" },
        h("table", {}, h("thead", {}, h("tr", {}, columns.map((text) => h("th", { scope: "col" }, text)))), this.body)))];
  }

  async start() {
    this.draw();
    for (const [make, element] of [[limitCurve, this.curve], [limitPoints, this.points]]) {
      try {
        this.charts.push(await make(element, this, this.signal));
      } catch (error) {
        this.charts.push(null);
        element.replaceChildren(h("p", { class: "trouble" }, error.message));
      }
    }
    this.follow();
  }

  async follow() {
    while (!this.signal.aborted && this.search.state === "running") {
      await new Promise((resolve) => { setTimeout(resolve, pollMs); });
      await this.reload();
    }
  }

  async reload() {
    try {
      this.search = await findSearch(this.search.id, this.signal);
      this.draw();
      for (const chart of this.charts) chart?.draw();
    } catch (error) {
      if (error.name !== "AbortError") notify(error.message, "trouble");
    }
  }

  draw() {
    const { search } = this;
    const { counts } = search;
    this.status.textContent = `${search.state}: ${Math.floor(100 * search.progress)} %, ${plural(counts.succeeded, "run")} of ${plural(counts.total, "job")} so far${search.error ? `; ${search.error}` : ""}`;
    const act = (text, run) => h("button", { onclick: () => run(search.id).then(() => this.reload()).then(() => this.follow()).catch((error) => notify(error.message, "trouble")) }, text);
    this.buttons.replaceChildren(...[
      h("a", { class: "button", href: limitsUrl(search.id, { format: "csv" }), download: `${search.name || search.id}.csv` }, "CSV"),
      h("a", { class: "button", href: routeTo("sweeps", search.sweep_id) }, "Its jobs"),
      search.state === "running" ? act("Cancel", cancelSearch) : null,
      ["failed", "cancelled"].includes(search.state) ? act("Retry", retrySearch) : null,
      search.state === "running" ? null : h("button", { class: "danger", onclick: () => this.remove() }, "Delete")].filter(Boolean));
    if (search.axes.length > 0 && !this.picker.hasChildNodes()) {
      const names = search.limits.map((limit, index) => [String(index), combinationOf(search, limit)]);
      this.picker.replaceChildren(choice("At", names, String(this.shown), (index) => { this.shown = Number(index); this.charts[1]?.draw(); }));
    }
    this.body.replaceChildren(...search.limits.map((limit) => this.row(limit)));
  }

  row(limit) {
    const falls = limit.falls.map(({ from, to, within_again: again }) => `${number(from)} to ${number(to)}${again ? " (within the bound again)" : ""}`).join("; ");
    const between = limit.verdict === "found" ? `${number(limit.limit)} to ${number(limit.limit_beyond)}` : limit.verdict === "never_exceeded" ? `beyond ${number(limit.limit)}` : "–";
    return h("tr", {}, this.search.axes.map((axis) => h("td", {}, pointOf(axis, limit[axis]))), h("td", {}, verdicts[limit.verdict]), h("td", {}, between),
      h("td", { class: "number" }, number(limit.band_from)), h("td", { class: "number" }, number(limit.band_to)), h("td", { class: "number" }, String(limit.evaluations)),
      h("td", {}, falls || "nowhere"));
  }

  async remove() {
    const { search } = this;
    if (!(await confirmed(`Delete “${search.name || search.id}”? Its jobs go with it; results that other sweeps share stay.`, "Delete"))) return;
    try {
      await deleteSearch(search.id);
      location.hash = "#/searches";
    } catch (error) {
      notify(error.message, "trouble");
    }
  }
}
