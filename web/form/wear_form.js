// SPDX-License-Identifier: Apache-2.0
// A new wear study: until when the bearing wears, and in which steps.
import { wearStudies } from "/core/api.js";
import { h } from "/core/dom.js";
import { StudyForm } from "/form/study_form.js";

const numbers = ["hours", "worn_clearance_mm", "wear_coefficient_m2_n", "max_depth_step_um", "max_rate_change",
  "max_cycles", "sectors"];
const names = { wear_coefficient_m2_n: "Wear coefficient" };
const units = { hours: "h", wear_coefficient_m2_n: "m²/N", max_depth_step_um: "µm", worn_clearance_mm: "mm" };

export class WearForm extends StudyForm {
  static api = wearStudies;
  static route = "wear";
  static title = "New wear study";
  static schema = "WearStudyRequest";

  parts() {
    return [this.nameField(),
      h("h2", {}, "Duration and resolution"), numbers.map((key) => this.number(key, units[key] ?? "", names[key])),
      h("h2", {}, "Linkage"), ...this.parameterFields(), this.described(),
      h("details", {}, h("summary", {}, "Priority"), h("p", { class: "actions" }, ...this.orderFields()))];
  }

  build() {
    const { request: { name, parameters, sweep = {}, priority, reuse }, problems } = this.buildCommon();
    for (const path of Object.keys(sweep)) problems.push({ path, detail: "must have a single value in a wear study" });
    const request = { name, parameters };
    this.addNumbers(numbers, request, problems);
    return { request: JSON.parse(JSON.stringify({ ...request, priority, reuse })), problems };
  }

  drawCount({ hours, worn_clearance_mm: clearance }) {
    const ends = [hours && `${hours} h`, clearance && `${clearance} mm`].filter(Boolean);
    this.count.textContent = ends.length > 0 ? `Until ${ends.join(" or ")}` : "No end given";
    this.cost.textContent = "One run per cycle, in sequence.";
  }

  rowOf(pointer) {
    const [, key] = pointer.split("/");
    return numbers.includes(key) ? key : super.rowOf(pointer);
  }
}
