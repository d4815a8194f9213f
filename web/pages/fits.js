// SPDX-License-Identifier: Apache-2.0
// Fits: their list, the form of a new one, and the view of one.
import { fits } from "/core/api.js";
import { FitForm } from "/form/fit_form.js";
import { fitFrom } from "/form/from_sweep.js";
import { showStudyForm } from "/form/study_form.js";
import { shortAnswerOf } from "/study/fit_answer.js";
import { FitView } from "/study/fit_view.js";
import { showStudies } from "/study/study_list.js";
import { showStudy } from "/study/study_view.js";
import { nameOfVariable } from "/study/variables.js";

const kind = {
  api: fits, route: "fits", title: "Fits",
  question: "Values of parameters with which jobs give measured signals, and how sure they are.",
    listName: "Fits", nouns: ["fit", "fits"],
  aim: { heading: "Parameters",
    /** @param {Api.Listed<"/v1/fits">} fit */
    textOf: ({ variables }) => variables.map(nameOfVariable).join(", ") },
  answerOf: shortAnswerOf, none: "No fits yet.", begin: "New fit",
};

/** @param {HTMLElement} main  @param {Visit} view */
export function show(main, { id, query, signal }) {
  if (id === "new") return showStudyForm(main, FitForm, fitFrom, query, signal);
  return id ? showStudy(main, FitView, id, signal) : showStudies(main, kind, signal);
}
