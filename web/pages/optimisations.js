// SPDX-License-Identifier: Apache-2.0
// Optimisations: their list, the form of a new one, and the view of one.
import { optimisations } from "/core/api.js";
import { nameOf } from "/core/format.js";
import { OptimisationView } from "/study/optimisation_view.js";
import { showStudies } from "/study/study_list.js";
import { showStudy } from "/study/study_view.js";

/** @param {Api.Listed<"/v1/optimisations">} study */
function aimOf({ objectives, variables }) {
  const goals = objectives.map(({ metric, goal = "minimise" }) => `${goal} ${nameOf(metric).toLowerCase()}`);
  return `${goals.join(", ")} over ${variables.map((path) => nameOf(path).toLowerCase()).join(", ")}`;
}

const kind = {
  api: optimisations, route: "optimisations", title: "Optimisations",
  question: "Values of parameters for which metrics are least or largest.", listName: "Optimisations",
  aim: { heading: "Goal", textOf: aimOf }, none: "No optimisations yet.", begin: "New optimisation",
};

/** @param {HTMLElement} main  @param {Visit} view */
export function show(main, { id, signal }) {
  return id ? showStudy(main, OptimisationView, id, signal) : showStudies(main, kind, signal);
}
