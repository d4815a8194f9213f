// SPDX-License-Identifier: Apache-2.0
// Wear studies: their list, the form of a new one, and the view of one.
import { wearStudies } from "/core/api.js";
import { exact } from "/core/format.js";
import { showStudyForm } from "/form/study_form.js";
import { WearForm } from "/form/wear_form.js";
import { showStudies } from "/study/study_list.js";
import { showStudy } from "/study/study_view.js";
import { WearView, shortAnswerOf } from "/study/wear_view.js";

// The paper's rigid linkage until its bearing has got 10 um wider at the deepest place.
const example = { name: "Bearing wear", parameters: { duration_s: 3 }, wear_coefficient_m2_n: 1e-15,
  worn_clearance_mm: 0.26, max_depth_step_um: 2 };

/** @type {(study: Api.Listed<"/v1/wear-studies">) => string} */
const untilOf = ({ hours, worn_clearance_mm: clearance }) => [hours === null ? "" : `${exact(hours)} h`,
  clearance === null ? "" : `${exact(clearance)} mm`].filter(Boolean).join(" or ");

const kind = {
  api: wearStudies, route: "wear", title: "Wear",
  question: "Wear of the bearing's bore over time, cycle by cycle; each cycle simulates the worn bore.",
  listName: "Wear studies", nouns: ["wear study", "wear studies"],
  aim: { heading: "End", textOf: untilOf }, answerOf: shortAnswerOf, none: "No wear studies yet.",
    begin: "New wear study",
};

/** @param {HTMLElement} main  @param {Visit} view */
export function show(main, { id, query, signal }) {
  if (id === "new") return showStudyForm(main, WearForm, () => example, query, signal);
  return id ? showStudy(main, WearView, id, signal) : showStudies(main, kind, signal);
}
