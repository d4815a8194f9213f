// SPDX-License-Identifier: Apache-2.0
// One wear study: the bore over its cycles, and how its depth grows.
import { wearStudies } from "/core/api.js";
import { choice, h } from "/core/dom.js";
import { number, plural } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { StudyView } from "/study/study_view.js";
import { wearGrowth, wearMap } from "/study/wear_charts.js";

/** @type {Record<Api.WearStudy["verdict"], string>} */
const verdicts = { open: "open", hours_reached: "end time reached", clearance_reached: "worn clearance reached",
  no_wear: "no wear", cycle_limit: "cycle limit reached",
  lost: "undetermined: a job failed" };

/// Progress of a study and the reason of its end, for a list.
/** @param {Api.WearStudy} study */
export function shortAnswerOf({ cycles, verdict, state, error }) {
  const last = cycles.at(-1);
  const reached = last ? `${number(last.hours)} h in ${plural(cycles.length, "cycle")}` : "";
  const why = verdict === "open" ? error ?? state : verdicts[verdict];
  return [reached, why].filter(Boolean).join(": ");
}

/** @extends {StudyView<Api.WearStudy>} */
export class WearView extends StudyView {
  static api = wearStudies;
  static route = "wear";

  tableName = "Cycles";
  ring = 0;  // the ring whose bore is drawn
  picker = h("span");

  charts() {
    return [{ title: "Bore", make: wearMap, above: this.picker }, { title: "Depth", make: wearGrowth }];
  }

  columns() {
    const numbers = ["Cycle", "Time [h]", "Maximum depth [µm]", "Angle [°]", "Clearance [mm]", "Rate [µm/h]",
      "Rate change [%]", "Worn volume [mm³]"];
    return [...numbers.map((heading) => [heading, "number"]), ["Job"]];
  }

  statusText() {
    const { state, progress, cycles, rejected_steps: halved, error, verdict } = this.study;
    const rejected = halved > 0 ? `, ${plural(halved, "step")} halved` : "";
    return `${state}: ${Math.floor(100 * progress)} `
      + `%, ${plural(cycles.length, "cycle")}${rejected}; ${error ?? verdicts[verdict]}`;
  }

  drawChoices() {
    const rings = this.study.cycles[0]?.wear_depth_um.length ?? 0;
    if (rings < 2 || this.picker.hasChildNodes()) return;
    const names = Array.from({ length: rings }, (_, ring) => [String(ring), String(ring + 1)]);
    this.picker.replaceChildren(choice("Ring", names, String(this.ring),
      (ring) => { this.ring = Number(ring); this.drawn[0]?.draw(); }));
  }

  rows() {
    return this.study.cycles.map(row);
  }
}

/** @param {Api.Schemas["WearCycle"]} cycle */
function row(cycle) {
  const degrees = cycle.deepest_angle_rad === null ? "–" : number((180 / Math.PI) * cycle.deepest_angle_rad, 3);
  const change = cycle.rate_change === null ? "–" : number(100 * cycle.rate_change, 2);
  const values = [String(cycle.cycle), number(cycle.hours), number(cycle.deepest_um), degrees,
    number(cycle.clearance_mm, 5), number(cycle.rate_um_h), change, number(cycle.worn_volume_mm3)];
  return h("tr", {}, values.map((value) => h("td", { class: "number" }, value)),
    h("td", {}, h("a", { href: routeTo("jobs", cycle.job_id) }, "run")));
}
