// SPDX-License-Identifier: Apache-2.0
// The paper's seven statements about the largest slider acceleration, held against a sweep.
import { analysisUrl, findAnalysis } from "/core/api.js";
import { h, setSeen } from "/core/dom.js";
import { nameOf, number, plural } from "/core/format.js";
import { routeTo } from "/core/route.js";
import { table } from "/analysis/parts.js";

/** @typedef {Api.Get<"/v1/sweeps/{id}/paper">[number]} Statement */

const axesNeeded = ["clearance_mm", "crank_velocity_rad_s", "coupler"];
const indexPrefix = "index.";
const leastIndex = 0.02;

/// True if a sweep varies the parameters that the paper's statements compare.
/** @type {(axes: string[]) => boolean} */
export const bearsOnPaper = (axes) => axesNeeded.every((axis) => axes.includes(axis));

/**
 * @param {HTMLElement} element
 * @param {AnalysedSweep} analysed
 * @param {AbortSignal} signal
 */
export async function paperCard(element, { sweep }, signal) {
  const rows = await findAnalysis(sweep.id, "paper", {}, signal);
  const [numbered, others] = split(rows);
  // Other velocities may be many, with jobs for few of their ratios.
  const told = others.filter(({ settings }) => settings > 0);
  const csv = { class: "button", href: analysisUrl(sweep.id, "paper", { format: "csv" }),
    download: `${sweep.name || sweep.id} paper.csv` };
  const isSingle = singleRuns(sweep) !== "";
  const note = isSingle
    ? [h("p", { role: "note" }, "One run each: replicates would show which ratios scatter.")] : [];
  element.replaceChildren(...note, statements("The paper's statements", numbered,
    isSingle, [["No.", (row) => row.number, "of"]]),
    ...(told.length === 0 ? []
      : [h("h3", { class: "quiet small" }, "Other velocities, on which the paper makes no statement"),
      statements("Other velocities", told, isSingle)]),
    told.length === others.length ? "" : h("p", { class: "quiet small" },
      `${plural(others.length - told.length, "ratio")} at other velocities ${others.length - told.length === 1
        ? "needs" : "need"} jobs that the sweep does not have.`),
    ...indexParts(numbered), h("p", { class: "actions" }, h("a", csv, "CSV")));
  return null;
}

/// Note on statements that are held against single runs; empty if the sweep has replicates.
/** @param {Api.Sweep} sweep */
const singleRuns = ({ request }) => (Number(request.replicates?.count ?? 1) > 1 ? "" : "one run each");

/// Summary of the numbered statements in words: "7 of 7 hold".
/** @param {Statement[]} rows */
function summaryOf(rows) {
  const [numbered] = split(rows);
  const told = numbered.filter(({ settings }) => settings > 0);
  if (told.some(({ settings }) => settings > 1)) {
    const shares = told.map(({ share }) => share).filter((share) => share !== null);
    const [least, most] = [Math.min(...shares), Math.max(...shares)].map(percent);
    return `each holds in ${least === most ? least : `${least} to ${most}`} of the settings`;
  }
  const missing = numbered.length - told.length;
  const holding = told.filter(({ holds }) => holds).length;
  if (told.length === 0) return `the sweep does not have the jobs that any of the ${numbered.length} needs`;
  return missing === 0 ? `${holding} of ${numbered.length} hold`
    : `${holding} of the ${told.length} statements that can be judged hold; ${missing} `
      + `${missing === 1 ? "needs" : "need"} jobs that the sweep does not have`;
}

/// Fills a line of the page of a sweep that has ended with the summary.
/** @param {HTMLElement} line  @param {Api.Sweep} sweep  @param {AbortSignal} signal */
export async function drawSummary(line, sweep, signal) {
  try {
    const summary = [summaryOf(await findAnalysis(sweep.id, "paper", {}, signal)), singleRuns(sweep)];
    line.replaceChildren(h("a", { href: routeTo("analyses", sweep.id) }, "The paper's statements"),
      `: ${summary.filter(Boolean).join("; ")}`);
    setSeen(line, true);
  } catch {
    setSeen(line, false);  // the page of the analyses says why
  }
}

/** @type {(rows: Statement[]) => [Statement[], Statement[]]} */
const split = (rows) => [rows.filter((row) => row.number !== null), rows.filter((row) => row.number === null)];
const percent = (part) => `${number(100 * part, 3)} %`;

/** @param {string} label  @param {Statement[]} rows  @param {boolean} isSingle  @param {any[]} first */
function statements(label, rows, isSingle, first = []) {
  const sentence = ({ text }) => text.charAt(0).toUpperCase() + text.slice(1);
  const printed = ({ paper }) => (paper === null ? "below 1" : number(paper));
  return table(label, rows,
    [...first, ["Statement", sentence, "text"], ["Paper", printed, "paper"], ["This sweep", foundIn, "here"],
    ["Verdict", (row) => verdictOf(row, isSingle), "verdict"]], "statements");
}

/** @param {Statement} statement */
function foundIn({ settings, found_least: least, found_largest: largest }) {
  if (settings === 0) return "–";
  const [from, to] = [number(least, 3), number(largest, 3)];
  return from === to ? from : `${from} to ${to}`;
}

/// Verdict on a statement. One run each tells too little to say that a statement does not hold.
/** @param {Statement} statement  @param {boolean} isSingle */
function verdictOf({ settings, share, holds }, isSingle) {
  if (settings === 0) return "–";
  if (settings > 1) return `in ${percent(share)} of ${plural(settings, "setting")}`;
  if (isSingle) return h("span", { class: "quiet" }, holds ? "holds" : "outside the paper's");
  return h("span", { class: holds ? "succeeded" : "failed" }, holds ? "holds" : "does not hold");
}

/// {parameter, index}s of a statement, largest first.
/** @param {Statement} row */
function indicesOf(row) {
  return Object.entries(row).map(([key, value]) => ({ key, index: Number(value) }))
    .filter(({ key, index }) => key.startsWith(indexPrefix) && index >= leastIndex)
    .map(({ key, index }) => ({ parameter: key.slice(indexPrefix.length), index })).sort((a, b) => b.index - a.index);
}

/// The statements' indices below a heading; nothing, if the sweep has too few settings for them.
/** @param {Statement[]} numbered */
function indexParts(numbered) {
  const rows = numbered.map((row) => ({ row, indices: indicesOf(row) })).filter(({ indices }) => indices.length > 0);
  if (rows.length === 0) return [];
  return [h("h3", {}, "Sensitivity of each statement"),
    h("p", { class: "quiet small" },
      "First-order sensitivity index: part of the variance of the logarithm of a statement's ratio that the "
      + `parameter alone makes. Shown from ${leastIndex} on.`),
    table("First-order sensitivity indices", rows, [["No.", ({ row }) => row.number],
      ["First-order sensitivity index", ({ indices }) => indices.map(indexBar)]])];
}

/** @param {{ parameter: string, index: number }} index */
function indexBar({ parameter, index }) {
  const bar = h("span", { class: "part", "aria-hidden": "true" });
  bar.style.width = `${100 * Math.min(index, 1)}%`;
  return h("div", { class: "index" }, h("span", {}, nameOf(parameter)), h("span", { class: "value" }, number(index, 2)),
    h("span", { class: "track", "aria-hidden": "true" }, bar));
}
