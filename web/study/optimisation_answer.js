// SPDX-License-Identifier: Apache-2.0
// An optimisation in sentences: what is looked for, and what came of it.
import { h } from "/core/dom.js";
import { exact, nameOf, number, plural, titleOf, unitOf } from "/core/format.js";
import { routeTo } from "/core/route.js";

const bounded = /_(at_most|at_least)$/;
/** @type {Record<Api.Schemas["OptimisationStart"]["end"], string>} */
const ends = { running: "running", converged: "converged", budget: "budget used", stopped: "stopped" };
/** @type {Record<Api.Optimisation["method"], string>} */
const methods = { cma_es: "CMA-ES, an evolution strategy", nsga2: "NSGA-II, which looks for the Pareto front",
  nelder_mead: "Nelder-Mead, a local search", bobyqa: "BOBYQA, a local search" };

/// Title of a column of candidates: variable, metric, or metric with a bound.
/** @param {string} column */
export function titleOfMetric(column) {
  const [ending, side] = bounded.exec(column) ?? ["", ""];
  const title = titleOf(column.slice(0, column.length - ending.length));
  return side ? `${title}, ${side.replace("_", " ")}` : title;
}

/** @type {(column: string, value: number) => string} */
const valueText = (column, value) => `${number(value)}${unitOf(column) ? ` ${unitOf(column)}` : ""}`;

/// The question as a sentence.
/** @param {Api.Optimisation} study */
export function aimOf({ objectives, variables, request, method }) {
  const goals = objectives.map(({ metric, goal = "minimise" }) => `${goal} ${nameOf(metric).toLowerCase()}`);
  const bounds = (request.bounds ?? []).map(({ metric, minimum, maximum }) =>
    [nameOf(metric).toLowerCase(), minimum === undefined ? "at most" : "at least", exact(minimum ?? maximum),
      unitOf(metric)].join(" ").trim());
  const free = variables.map((path) => nameOf(path).toLowerCase()).join(", ");
  const text = `${goals.join(", ")} over ${free}${bounds.length > 0 ? `, with ${bounds.join(", ")}` : ""}`;
  return `${text.charAt(0).toUpperCase()}${text.slice(1)}. Method: ${methods[method]}.`;
}

/// The answer in one line; why there is none, if there is none.
/** @param {Api.Optimisation} study */
export function shortAnswerOf({ best, front, objectives, error }) {
  if (objectives.length > 1) return `${plural(front.length, "candidate")} on the Pareto front`;
  if (!best) return error ?? "No feasible candidate";
  const [{ metric }] = objectives;
  const at = Object.entries(best.values).map(([path, value]) =>
    `${nameOf(path).toLowerCase()} ${valueText(path, Number(value))}`).join(", ");
  return `${nameOf(metric)} ${valueText(metric, Number(best.metrics[metric]))} with ${at}`;
}

/// The answer in sentences, with a link to the best job.
/** @param {Api.Optimisation} study  @returns {HTMLElement[]} */
export function answerOf(study) {
  const { state, best, best_repeats: repeats, starts, objectives, lost_reasons: reasons } = study;
  const lost = Object.entries(reasons)
    .map(([reason, count]) => `${plural(count, "candidate")}: ${reason}`).join("; ");
  const trouble = lost ? [h("p", { class: "trouble" }, `Candidates without a value: ${lost}.`)] : [];
  const told = h("p", { class: "big" }, `${state === "running" ? "So far: " : ""}${shortAnswerOf(study)}.`);
  if (objectives.length > 1) return [told, ...trouble];
  if (!best) {
    return [h("p", { class: "big" }, state === "running" ? "No feasible candidate yet."
      : "No feasible candidate."),
      ...trouble];
  }
  const [job, ...more] = best.job_ids;
  const ended = starts.map(({ end, candidates, generations }) =>
    `${ends[end]} after ${plural(candidates, "candidate")} in ${plural(generations, "generation")}`)
    .join("; ");
  return [told, h("p", {}, `${plural(starts.length, "start")}: ${ended}.`
      + `${starts.length > 1 ? ` ${repeats} of ${starts.length} came within 1 % of the best.` : ""}`),
    h("p", { class: "actions" },
      h("a", { class: "button main", href: routeTo("jobs", job, { with: more.slice(0, 5).join(",") }) },
        more.length === 0 ? "Best job" : "Best jobs")), ...trouble];
}
