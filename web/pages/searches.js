// SPDX-License-Identifier: Apache-2.0
// Limit searches: their list, the form of a new one, and the view of one.
import { searches } from "/core/api.js";
import { exact, nameOf, titleOf, unitOf } from "/core/format.js";
import { SearchForm } from "/form/search_form.js";
import { showStudyForm } from "/form/study_form.js";
import { LimitView, shortAnswerOf } from "/study/limit_view.js";
import { showStudies } from "/study/study_list.js";
import { showStudy } from "/study/study_view.js";

// Largest clearance of the paper's flexible linkage.
const example = {
  name: "Clearance limit",
  parameters: { coupler: "flexible", duration_s: 3 },
  over: { clearance_mm: { from: 0.05, to: 0.5, tolerance: 0.02 } },
  metric: "amplification",
  bound: 20,
  quantile: 0.9,
  sweep: { crank_velocity_rad_s: [5, 8, 10] },
  replicates: { count: 8 },
};

/** @param {Api.Listed<"/v1/searches">} search */
function aimOf({ parameter, metric, bound }) {
  const unit = unitOf(metric);
  return `${titleOf(parameter)} with ${nameOf(metric).toLowerCase()} up to ${exact(bound)}${unit ? ` ${unit}` : ""}`;
}

const kind = {
  api: searches, route: "searches", title: "Limits",
  question: "Limit of a parameter: the last value before a metric first exceeds its bound.", listName: "Searches",
    nouns: ["search", "searches"],
  aim: { heading: "Target", textOf: aimOf }, answerOf: shortAnswerOf, none: "No searches yet.",
    begin: "New search",
};

/** @param {HTMLElement} main  @param {Visit} view */
export function show(main, { id, query, signal }) {
  if (id === "new") return showStudyForm(main, SearchForm, () => example, query, signal);
  return id ? showStudy(main, LimitView, id, signal) : showStudies(main, kind, signal);
}
