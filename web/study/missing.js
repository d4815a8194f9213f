// SPDX-License-Identifier: Apache-2.0
// Texts on jobs that were computed but have no value of the metric.
import { nameOf, plural } from "/core/format.js";

const ofContacts = /contact|penetration|sliding/;

/// The jobs that it is about.
/** @type {(sweep: Pick<SweepPage, "rows" | "view">) => Api.Row[]} */
export const withoutValue = ({ rows, view }) => rows.filter((row) => row.state === "succeeded"
  && typeof row[view.metric] !== "number");

/// The value of a parameter in a row: swept, given to all jobs, or the default.
/** @param {Pick<SweepPage, "sweep" | "schema">} sweep  @param {Api.Row} row  @param {keyof Api.Parameters} key */
function parameterOf({ sweep, schema }, row, key) {
  return row[key] ?? sweep.request.parameters?.[key] ?? schema.properties[key]?.default;
}

/// Number of jobs that end before their steady window begins.
/** @param {SweepPage} sweep  @param {Api.Row[]} rows */
function countEarly(sweep, rows) {
  return rows.filter((row) => parameterOf(sweep, row, "duration_s") <= parameterOf(sweep, row, "run_up_s")).length;
}

/// Text on the number of jobs without a value that ended too early.
function earlyText(early, all) {
  if (early === 0) return "and a run must last longer";
  if (early === all) return "and these have ended by then";
  return `and ${early.toLocaleString("en")} of these ${early === 1 ? "has" : "have"} ended by then`;
}

/// A sentence on the jobs without a value; empty if all have one.
/** @param {SweepPage} sweep */
export function missingText(sweep) {
  const without = withoutValue(sweep);
  if (without.length === 0) return "";
  const early = earlyText(countEarly(sweep, without), without.length);
  return `${plural(without.length, "computed job")} without a value of ${nameOf(sweep.view.metric)}: `
    + `values of the steady part count from run_up_s on, ${early}; those of contacts need a clearance.`;
}

/// Reason why a chart is empty, in few words.
/** @param {SweepPage} sweep */
export function whyEmpty(sweep) {
  const without = withoutValue(sweep);
  if (without.length === 0) return sweep.rows.some(({ state }) => state === "failed")
    ? "Jobs have failed: the table says why." : "";
  if (ofContacts.test(sweep.view.metric)) return "Values of contacts need a clearance.";
  return countEarly(sweep, without) === without.length ? "The runs end before their steady part: at or before run_up_s."
    : "";
}
