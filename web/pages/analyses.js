// SPDX-License-Identifier: Apache-2.0
// Analyses of a sweep, each in a card of its own.
import { findResults, findSweep, reportUrl } from "/core/api.js";
import { loadCharts, saveButtons } from "/core/charts.js";
import { h, setSeen } from "/core/dom.js";
import { retryWhileUnreachable } from "/core/live.js";
import { quantityChoice } from "/core/quantities.js";
import { rememberQuery, routeTo } from "/core/route.js";
import { metricsOf, usualMetric } from "/study/data.js";
import { bifurcationCard } from "/analysis/bifurcation.js";
import { flexibilityCard, isOfLink } from "/analysis/flexibility.js";
import { lyapunovCard } from "/analysis/lyapunov.js";
import { bearsOnPaper, paperCard } from "/analysis/paper.js";
import { sensitivityCard } from "/analysis/sensitivity.js";
import { surrogateCard } from "/analysis/surrogate.js";

/** @type {MakeCard[]} */
const needMetric = [flexibilityCard, sensitivityCard, surrogateCard];
const usual = "peak_slider_acceleration_m_s2";  // only RPSUP has it

/** @param {HTMLElement} main  @param {Visit} view */
export async function show(main, { id, query, signal }) {
  loadCharts().catch(() => {});  // told where a chart would be
  const [sweep, rows] = await Promise.all([findSweep(id, signal), findResults(id, { limit: 50 }, signal)]);
  const metrics = metricsOf(rows, sweep.axes);
  const isRpsup = metrics.includes(usual);
  const numbers = sweep.axes.filter((axis) => typeof rows[0][axis] === "number");
  const analysed = { sweep, numbers, isRpsup, jobId: rows[0].job_id,
    hasClearance: metrics.some((metric) => metric.endsWith("contact_time_ratio")),
    metric: metrics.find((metric) => metric === query.get("metric"))
    ?? (isRpsup ? usual : usualMetric(metrics, rows, sweep)) };
  const name = sweep.name || sweep.id;
  document.title = `RPSUP: analysis of ${name}`;
  const cards = h("div");
  const report = h("a", { class: "button" }, "Report");
  let life = new AbortController();
  const draw = () => {
    report.href = reportUrl(id, { metric: analysed.metric });
    life.abort();
    life = new AbortController();
    const ofMetric = AbortSignal.any([signal, life.signal]);
    cardsFor(analysed).forEach(([title, help, make], index) => {
      const old = cards.children[index];
      if (old && !needMetric.includes(make)) return;
      const made = card(name, title, help, make, analysed, needMetric.includes(make) ? ofMetric : signal);
      if (old) old.replaceWith(made);
      else cards.append(made);
    });
  };
  const pick = quantityChoice("Metric", "metrics", metrics, analysed.metric,
    (metric) => { analysed.metric = metric; rememberQuery({ metric }); draw(); });
  main.replaceChildren(h("div", { class: "head" }, h("h1", {}, `Analysis of ${name}`),
    h("p", { class: "actions" }, h("a", { class: "button", href: routeTo("sweeps", id) }, "Sweep"),
      report)),
  h("p", { class: "actions" }, pick), cards);
  draw();
}

/// Analyses that apply to a sweep.
/**
 * @typedef {(element: HTMLElement, analysed: AnalysedSweep, signal: AbortSignal) =>
 *   Promise<Chart | null>} MakeCard
 */
/** @param {AnalysedSweep} analysed  @returns {[string, string, MakeCard][]} */
function cardsFor({ sweep, numbers, isRpsup, hasClearance }) {
  const type = sweep.request.design?.type;
  /** @type {([string, string, MakeCard] | false | undefined | "")[]} */
  const cards = [
    isRpsup && bearsOnPaper(sweep.axes)
      && ["The paper's statements", "Ratios of the largest slider acceleration in the steady window. "
      + "Statement 1 holds within 5 %, statements 2 to 5 within 20 %, 6 and 7 below 1.", paperCard],
    sweep.axes.some(isOfLink)
      && ["Effect of flexibility",
        "Metric with the flexible link / metric with the rigid one; bars: range over the replicates.",
        flexibilityCard],
    type && ["morris", "saltelli"].includes(type)
      && ["Sensitivity", type === "morris" ? "Morris: elementary effects of the whole range of each parameter."
        : "Sobol indices: share of the variance due to each parameter, alone (first order) and with its interactions "
        + "(total); bars: 95 % confidence.", sensitivityCard],
    numbers.length > 0 && ["Surrogate",
      "Polynomial chaos expansion fitted to the jobs, with its error of leave-one-out cross-validation.",
      surrogateCard],
    numbers.length > 0 && ["Bifurcation diagram", "A channel once per revolution, for each job.", bifurcationCard],
    hasClearance && sweep.request.replicates
      && ["Largest Lyapunov exponent",
        "Divergence rate of runs with nearly equal contact stiffness; an interval above 0 means chaos.", lyapunovCard],
  ];
  return cards.filter(Boolean);
}

function card(name, title, help, make, analysed, signal) {
  const body = h("div");
  let chart = null;
  const save = saveButtons(() => chart, () => `${name} ${title.toLowerCase()}`);
  setSeen(save, false);
  const tell = (text) => text && body.replaceChildren(h("p", { class: "trouble", role: "status" }, text));
  retryWhileUnreachable(() => make(body, analysed, signal), tell, signal).then((made) => {
    chart = made;
    if (made) setSeen(save, true);
    else save.remove();
  }).catch((error) => {
    if (error.name !== "AbortError") body.replaceChildren(h("p", { class: "trouble" }, error.message));
  });
  return h("section", { class: "card" }, h("div", { class: "head" }, h("h2", {}, title), save),
    h("p", { class: "quiet small" }, help), body);
}
