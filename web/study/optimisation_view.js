// SPDX-License-Identifier: Apache-2.0
// One optimisation: the best so far, the Pareto front, and all candidates, which share a selection.
import { optimisations } from "/core/api.js";
import { choice, h } from "/core/dom.js";
import { number, plural, titleOf } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { bestSoFarChart } from "/study/best_so_far.js";
import { candidateScatter } from "/study/candidate_scatter.js";
import { drawChosen } from "/study/chosen.js";
import { aimOf, answerOf, titleOfMetric } from "/study/optimisation_answer.js";
import { parallelChart } from "/study/parallel.js";
import { Selection } from "/study/selection.js";
import { StudyView } from "/study/study_view.js";
import { ResultTable } from "/study/table.js";

/**
 * @typedef {Required<Pick<Api.Schemas["CandidateRows"][number], "candidate" | "state" | "on_front">>
 *   & { job_id: string, lost_reason: string | null, [column: string]: any }} CandidateRow
 */

/** @extends {StudyView<Api.Optimisation>} */
export class OptimisationView extends StudyView {
  static api = optimisations;
  static route = "optimisations";

  /** @type {CandidateRow[]} */
  candidates = [];
  selection = new Selection();
  chosen = h("p", { class: "actions card", hidden: true });
  answer = h("div");
  objectivePicker = h("p", { class: "actions" });
  axisPicker = h("p", { class: "actions" });

  /** @param {Api.Optimisation} study  @param {AbortSignal} signal */
  constructor(study, signal) {
    super(study, signal);
    this.metrics = study.objectives.map(({ metric }) => metric);
    this.bounds = (study.request.bounds ?? []).map(({ metric, minimum }) =>
      `${metric}_${minimum === undefined ? "at_most" : "at_least"}`);
    this.hasFront = this.metrics.length > 1;
    this.tableName = this.hasFront ? "Pareto front" : "Best candidate";
    this.objective = this.metrics[0];
    this.x = this.hasFront ? this.metrics[0] : study.variables[0];
    this.y = this.hasFront ? this.metrics[1] : this.metrics[0];
    const shared = { selection: this.selection, sweep: { request: {} }, others: null,
      failures: { of: () => undefined }, view: { metric: this.metrics[0], x: "", y: "", panel: "" } };
    /// Candidates as the table and the parallel coordinates of a sweep take them.
    /** @type {any} */
    this.asSweep = { ...shared, rows: [], axes: study.variables, metrics: [...this.metrics, ...this.bounds] };
    /** @type {any} */
    this.asLines = { ...shared, rows: [], axes: [...study.variables, ...this.metrics.slice(1)], metrics: [] };
    this.table = new ResultTable(this.asSweep, { noun: "candidate", titleOf: titleOfMetric });
    this.selection.addEventListener("change", () => this.drawSelection());
  }

  charts() {
    return [{ title: "Best so far", make: bestSoFarChart, above: this.objectivePicker },
      { title: this.hasFront ? "Pareto front" : "Candidates", make: candidateScatter,
        above: this.axisPicker },
      { title: "Parallel coordinates", wide: true,
        make: (element, view, signal) => parallelChart(element, view.asLines, signal),
        above: h("p", { class: "quiet small" },
          "Drag along an axis to select candidates; click the axis to clear its selection.") }];
  }

  intro() { return [h("p", {}, aimOf(this.study)), this.answer, this.chosen]; }

  more() {
    return [h("section", { class: "card" }, h("h2", {}, "Candidates"), this.table.element)];
  }

  columns() {
    const numbers = [...this.study.variables.map((path) => titleOf(path)),
      ...[...this.metrics, ...this.bounds].map(titleOfMetric)];
    return [["Select"], ...numbers.map((text) => [text, "number"]), ["Jobs"]];
  }

  statusText() {
    const { state, candidates, budget, error } = this.study;
    const done = candidates.feasible + candidates.infeasible + candidates.lost;
    const counts = Object.entries(candidates).filter(([, count]) => count > 0)
      .map(([each, count]) => `${count.toLocaleString("en")} ${each}`).join(", ");
    return `${state}: ${done.toLocaleString("en")} of at most ${plural(budget, "candidate")}`
      + `${counts ? `; ${counts}` : ""}${error ? `; ${error}` : ""}`;
  }

  async findMore() {
    const rows = await optimisations.results(this.study.id, {}, this.signal);
    this.candidates = rows.filter(({ job_id: job }) => job !== null);
    const hasAll = (row) => this.metrics.every((metric) => typeof row[metric] === "number");
    this.asLines.rows = this.candidates.filter(hasAll).map((row) => ({ ...row, state: "succeeded" }));
    this.asSweep.rows = this.candidates.map((row) =>
      (row.lost_reason ? { ...row, state: `${row.state}: ${row.lost_reason}` } : row));
  }

  draw() {
    super.draw();
    this.answer.replaceChildren(...answerOf(this.study));
    this.table.draw();
    drawChosen(this.chosen, this.selection, "candidate");
  }

  drawSelection() {
    this.body.replaceChildren(...this.rows());
    this.table.draw();
    drawChosen(this.chosen, this.selection, "candidate");
    for (const chart of this.drawn.slice(1)) chart?.draw();
  }

  drawChoices() {
    if (this.axisPicker.hasChildNodes()) return;
    const columns = [...this.metrics, ...this.bounds, ...this.study.variables]
      .map((name) => [name, titleOfMetric(name)]);
    const axis = (label, key) => choice(label, columns, this[key],
      (name) => { this[key] = name; this.drawn[1]?.draw(); });
    const selectFront = h("button", { onclick: () => this.selection.set(this.study.front
      .map(({ job_ids: [job] }) => job)) }, "Select the front");
    this.axisPicker.replaceChildren(axis("x axis", "x"), axis("y axis", "y"),
      this.hasFront ? selectFront : "");
    this.objectivePicker.replaceChildren(choice("Objective",
      this.metrics.map((metric) => [metric, titleOf(metric)]), this.objective,
      (metric) => { this.objective = metric; this.drawn[0]?.draw(); }));
  }

  rows() {
    const { best, front } = this.study;
    const shown = this.hasFront ? [...front] : best ? [best] : [];
    return shown.sort((a, b) => Number(a.metrics[this.metrics[0]]) - Number(b.metrics[this.metrics[0]]))
      .map((candidate) => this.row(candidate));
  }

  /** @param {Api.Schemas["Candidate"]} candidate */
  row({ values, metrics, job_ids: [first, ...more] }) {
    const box = h("input", { type: "checkbox", "aria-label": `Select the candidate of ${first}`,
      onchange: () => this.selection.toggle([first]) });
    box.checked = this.selection.has(first);
    const numbers = [...this.study.variables.map((path) => values[path]),
      ...[...this.metrics, ...this.bounds].map((metric) => metrics[metric])];
    return h("tr", { class: box.checked ? "selected" : null }, h("td", {}, box),
      numbers.map((value) => h("td", { class: "number" }, number(/** @type {any} */ (value)))),
      h("td", { class: "fixed" },
        h("a", { href: routeTo("jobs", first, { with: more.slice(0, 5).join(",") }) },
        more.length === 0 ? "job" : plural(more.length + 1, "job"))));
  }
}
