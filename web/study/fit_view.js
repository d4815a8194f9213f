// SPDX-License-Identifier: Apache-2.0
// One fit: values with intervals, how they were found, and measured over predicted signals.
import { findFitSignals, fits } from "/core/api.js";
import { choice, h, tellTrouble } from "/core/dom.js";
import { number, plural } from "/core/format.js";
import { retryWhileUnreachable } from "/core/live.js";
import { routeTo } from "/core/route.js";
import { answerOf, correlationCard, errorsCard, lostOf, stageNames } from "/study/fit_answer.js";
import { computed, fitConvergence, fitMisfit, runningBest } from "/study/fit_points.js";
import { fitSignals, nameOfSignal } from "/study/fit_signals.js";
import { intervalBar, intervalText } from "/study/interval_bar.js";
import { StudyView } from "/study/study_view.js";
import { nameOfVariable, unitOfVariable } from "/study/variables.js";

/** @extends {StudyView<Api.Fit>} */
export class FitView extends StudyView {
  static api = fits;
  static route = "fits";

  tableName = "Parameters";
  /** @type {import("/study/fit_points.js").Point[]} */
  points = [];
  /** @type {import("/study/fit_signals.js").Sample[]} */
  samples = [];
  shownSignal = 0;  // among those of the fit
  shownVariable = "";  // empty: all
  samplesOf = "";  // signal and best point of the samples
  answer = h("div");
  below = h("div");
  signalPicker = h("p", { class: "actions" });
  predictedBy = h("span", { class: "quiet small" });
  variablePicker = h("p", { class: "actions" });

  charts() {
    return [{ title: "Convergence", make: fitConvergence, above: this.variablePicker },
      { title: "Misfit", make: fitMisfit },
      { title: "Signals", make: fitSignals, above: this.signalPicker, wide: true }];
  }

  intro() {
    const { measurement_ids: ids } = this.study;
    return [h("p", { class: "quiet small" }, `Fitted to ${plural(ids.length, "measurement")}: `,
      ids.flatMap((id, index) => [index > 0 ? ", " : "", h("a", { href: routeTo("measurements", id) }, id)])),
    this.answer];
  }

  more() { return [this.below]; }

  columns() {
    return [["Parameter"], ["Value", "number"], ["Unit"], ["95 % interval, profile"],
      ["95 % interval, linearised"], ["Range"], ["Between its bounds"], ["Identified"]];
  }

  statusText() {
    const { state, progress, stage, points, error } = this.study;
    const now = state === "running" ? `, ${stageNames[stage]}` : "";
    const lost = points.lost > 0 ? `, ${points.lost} lost` : "";
    return `${state}: ${Math.floor(100 * progress)} %${now}; ${plural(points.succeeded, "point")}${lost}`
      + `${error ? `; ${error}` : ""}`;
  }

  async findMore() {
    const columns = ["point", "stage", "sum_of_squares", "lost_reason", ...this.study.variables];
    this.points = await fits.results(this.study.id, { fields: columns.join(",") }, this.signal);
    await this.findSamples();
    if (this.study.state === "running") this.#showBestSoFar();
  }

  /// The service tells the best values at the end of a stage: the points know better ones meanwhile.
  #showBestSoFar() {
    const best = runningBest(computed(this)).at(-1);
    if (!best) return;
    for (const parameter of this.study.parameters) parameter.value = Number(best[parameter.path]);
  }

  /// Signal and best point of the samples that are to be shown; empty if there is no signal.
  #wantedSamples() {
    return this.shownSignal in this.study.signals ? JSON.stringify([this.shownSignal, this.study.best?.point]) : "";
  }

  /// Samples of the signal that is shown, unless they are those of the best point already.
  async findSamples() {
    const wanted = this.#wantedSamples();
    if (wanted === this.samplesOf) return;
    const shown = this.study.signals[this.shownSignal];
    const samples = shown ? await findFitSignals(this.study.id,
      { measurement_id: shown.measurement_id, run: shown.run, channel: shown.channel }, this.signal) : [];
    if (wanted !== this.#wantedSamples()) return;  // meanwhile others are asked for
    this.samples = samples;
    this.samplesOf = wanted;
  }

  draw() {
    super.draw();
    this.predictedBy.textContent = this.study.best ? `predicted by point ${this.study.best.point}` : "";
    this.answer.replaceChildren(...answerOf(this.study), ...lostOf(this.points));
    this.below.replaceChildren(...[errorsCard(this.study), correlationCard(this.study)]
      .filter((card) => card !== null));
  }

  drawChoices() {
    const { signals, measurement_ids: measurements, variables } = this.study;
    if (!this.variablePicker.hasChildNodes()) this.variablePicker.replaceChildren(choice("Parameter",
      [["", "all, between their bounds"], ...variables.map((path) => [path, nameOfVariable(path)])],
        this.shownVariable,
      (path) => { this.shownVariable = path; this.drawn[0]?.draw(); }));
    if (signals.length === 0 || this.signalPicker.hasChildNodes()) return;
    const names = signals.map((signal, index) => [String(index),
      nameOfSignal(signal, signals, measurements)]);
    this.signalPicker.replaceChildren(choice("Signal", names, String(this.shownSignal), (index) => {
      this.shownSignal = Number(index);
      retryWhileUnreachable(() => this.findSamples(), tellTrouble, this.signal).then(() => this.drawn[2]?.draw())
        .catch((error) => { if (error.name !== "AbortError") tellTrouble(error.message); });
    }), this.predictedBy);
  }

  rows() {
    return this.study.parameters.map((parameter) => {
      const { path, value, linearised, profile, range, identified } = parameter;
      const told = identified === null ? "–" : identified ? "yes" : "no";
      return h("tr", {}, h("td", { title: path }, nameOfVariable(path)),
        h("td", { class: "number" }, number(value, 5)),
        h("td", {}, unitOfVariable(path) || "1"), h("td", { class: "fixed" }, intervalText(profile, 5)),
        h("td", { class: "fixed" }, intervalText(linearised, 5)),
        h("td", { class: "fixed" }, intervalText(range, 5)),
          h("td", {}, intervalBar(parameter, this.isLog(path)),
          h("span", { class: "small quiet" }, intervalText({ low: parameter.from, high: parameter.to }))),
        h("td", { class: identified === false ? "trouble" : null }, told));
    });
  }

  /** @param {string} path */
  isLog(path) {
    return this.study.request.over[path]?.scale === "log";
  }

  /// Part of the way from the lower to the upper bound, 0 to 1.
  /** @param {string} path  @param {number} value */
  partOf(path, value) {
    const { from, to } = this.study.request.over[path];
    return this.isLog(path) ? Math.log(value / from) / Math.log(to / from) : (value - from) / (to - from);
  }
}
