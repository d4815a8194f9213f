// SPDX-License-Identifier: Apache-2.0
// Optimisations: their list, the form of a new one, and the view of one.
import { optimisations } from "/core/api.js";
import { nameOf } from "/core/format.js";
import { optimisationFrom } from "/form/from_sweep.js";
import { OptimisationForm } from "/form/optimisation_form.js";
import { showStudyForm } from "/form/study_form.js";
import { shortAnswerOf } from "/study/optimisation_answer.js";
import { OptimisationView } from "/study/optimisation_view.js";
import { showStudies } from "/study/study_list.js";
import { showStudy } from "/study/study_view.js";

// The coupler and the restitution that halve the peak of the flexible linkage at 12 rad/s.
const example = {
  name: "half the peak",
  parameters: { coupler: "flexible", crank_velocity_rad_s: 12 },
  over: { coupler_diameter_mm: { from: 8, to: 14, start: 10 },
    restitution: { from: 0.5, to: 0.95, start: 0.9 } },
  objectives: [{ metric: "peak_slider_acceleration_m_s2", goal: "minimise" }],
  budget: 18,
  starts: 1,
};

/** @param {Api.Listed<"/v1/optimisations">} study */
function aimOf({ objectives, variables }) {
  const goals = objectives.map(({ metric, goal = "minimise" }) => `${goal} ${nameOf(metric).toLowerCase()}`);
  return `${goals.join(", ")} over ${variables.map((path) => nameOf(path).toLowerCase()).join(", ")}`;
}

const kind = {
  api: optimisations, route: "optimisations", title: "Optimisations",
  question: "Values of parameters for which metrics are least or largest.", listName: "Optimisations",
    nouns: ["optimisation", "optimisations"],
  aim: { heading: "Goal", textOf: aimOf }, answerOf: shortAnswerOf, none: "No optimisations yet.",
    begin: "New optimisation",
};

/** @param {HTMLElement} main  @param {Visit} view */
export function show(main, { id, query, signal }) {
  if (id === "new") {
    const begin = (asked, until) => optimisationFrom(asked, example, until);
    return showStudyForm(main, OptimisationForm, begin, query, signal);
  }
  return id ? showStudy(main, OptimisationView, id, signal) : showStudies(main, kind, signal);
}
