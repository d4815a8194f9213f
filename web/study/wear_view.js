// One wear study: the bore over its cycles, and how its depth grows.
import { cancelWearStudy, deleteWearStudy, findWearStudy, retryWearStudy, wearCyclesUrl } from "/core/api.js";
import { loadCharts, saveButtons } from "/core/charts.js";
import { confirmed } from "/core/dialog.js";
import { choice, h, notify } from "/core/dom.js";
import { number, plural } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { wearGrowth, wearMap } from "/study/wear_charts.js";

const pollMs = 1000;
const verdicts = { open: "not ended yet", hours_reached: "the hours are over", clearance_reached: "the clearance is reached", no_wear: "nothing is worn", cycle_limit: "as many cycles as were allowed",
  lost: "a failed job is in the way" };
const columns = ["Cycle", "Hours", "Deepest [µm]", "at [°]", "Clearance there [mm]", "Rate [µm/h]", "Change of the rate [%]", "Worn volume [mm³]", "Job"];

export async function showWear(main, id, signal) {
  loadCharts().catch(() => {});  // told where a chart would be
  const view = new WearView(await findWearStudy(id, signal), signal);
  main.replaceChildren(...view.parts());
  await view.start();
}

class WearView {
  constructor(study, signal) {
    Object.assign(this, { study, signal, ring: 0, charts: [] });
  }

  parts() {
    const name = this.study.name || this.study.id;
    document.title = `RPSUP: ${name}`;
    this.status = h("p", { role: "status" });
    this.buttons = h("p", { class: "actions" });
    this.picker = h("span");
    this.body = h("tbody");
    this.map = h("div", { class: "chart tall" });
    this.growth = h("div", { class: "chart tall" });
    const card = (title, element, index, more = "") => h("section", { class: "card" },
      h("div", { class: "head" }, h("h2", {}, title), saveButtons(() => this.charts[index], () => `${name} ${title.toLowerCase()}`)), more, element);
    return [
      h("div", { class: "head" }, h("div", {}, h("h1", {}, name), this.status), this.buttons),
      h("div", { class: "columns even" }, card("Bore", this.map, 0, this.picker), card("Depth", this.growth, 1)),
      h("section", { class: "card" }, h("h2", {}, "Cycles"), h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Cycles" },
        h("table", {}, h("thead", {}, h("tr", {}, columns.map((text) => h("th", { scope: "col" }, text)))), this.body)))];
  }

  async start() {
    this.draw();
    for (const [make, element] of [[wearMap, this.map], [wearGrowth, this.growth]]) {
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
    while (!this.signal.aborted && this.study.state === "running") {
      await new Promise((resolve) => { setTimeout(resolve, pollMs); });
      await this.reload();
    }
  }

  async reload() {
    try {
      this.study = await findWearStudy(this.study.id, this.signal);
      this.draw();
      for (const chart of this.charts) chart?.draw();
    } catch (error) {
      if (error.name !== "AbortError") notify(error.message, "trouble");
    }
  }

  draw() {
    const { study } = this;
    const rejected = study.rejected_steps > 0 ? `, ${plural(study.rejected_steps, "step")} halved` : "";
    this.status.textContent = `${study.state}: ${Math.floor(100 * study.progress)} %, ${plural(study.cycles.length, "cycle")}${rejected}; ${study.error ?? verdicts[study.verdict]}`;
    const act = (text, run) => h("button", { onclick: () => run(study.id).then(() => this.reload()).then(() => this.follow()).catch((error) => notify(error.message, "trouble")) }, text);
    this.buttons.replaceChildren(...[
      h("a", { class: "button", href: wearCyclesUrl(study.id, { format: "csv" }), download: `${study.name || study.id}.csv` }, "CSV"),
      h("a", { class: "button", href: routeTo("sweeps", study.sweep_id) }, "Its jobs"),
      study.state === "running" ? act("Cancel", cancelWearStudy) : null,
      ["failed", "cancelled"].includes(study.state) ? act("Retry", retryWearStudy) : null,
      study.state === "running" ? null : h("button", { class: "danger", onclick: () => this.remove() }, "Delete")].filter(Boolean));
    const rings = study.cycles[0]?.wear_depth_um.length ?? 0;
    if (rings > 1 && !this.picker.hasChildNodes()) {
      const names = Array.from({ length: rings }, (_, ring) => [String(ring), String(ring + 1)]);
      this.picker.replaceChildren(choice("Ring", names, String(this.ring), (ring) => { this.ring = Number(ring); this.charts[0]?.draw(); }));
    }
    this.body.replaceChildren(...study.cycles.map(row));
  }

  async remove() {
    const { study } = this;
    if (!(await confirmed(`Delete “${study.name || study.id}”? Its jobs go with it; results that other sweeps share stay.`, "Delete"))) return;
    try {
      await deleteWearStudy(study.id);
      location.hash = "#/wear";
    } catch (error) {
      notify(error.message, "trouble");
    }
  }
}

function row(cycle) {
  const degrees = cycle.deepest_angle_rad === null ? "–" : number((180 / Math.PI) * cycle.deepest_angle_rad, 3);
  const change = cycle.rate_change === null ? "–" : number(100 * cycle.rate_change, 2);
  const values = [String(cycle.cycle), number(cycle.hours), number(cycle.deepest_um), degrees, number(cycle.clearance_mm, 5), number(cycle.rate_um_h), change, number(cycle.worn_volume_mm3)];
  return h("tr", {}, values.map((value) => h("td", { class: "number" }, value)), h("td", {}, h("a", { href: routeTo("jobs", cycle.job_id) }, "run")));
}
