// SPDX-License-Identifier: Apache-2.0
// Sentences on a sweep: its largest and least value with their parameters, failures, and the scatter of
// replicates.
import { h } from "/core/dom.js";
import { nameOf, number, plural, timeMetricOf, unitOf } from "/core/format.js";
import { term } from "/core/quantities.js";
import { routeTo } from "/core/route.js";
import { none, valueOf } from "/study/data.js";

/** @type {(value: number, name: string) => string} */
const withUnit = (value, name) => [number(value), unitOf(name)].filter(Boolean).join(" ");

/// "crank velocity 15 rad/s, coupler rigid"
/** @param {Api.Row} row  @param {string[]} axes */
function settingOf(row, axes) {
  return axes.filter((axis) => valueOf(row, axis) !== none).map((axis) => {
    const value = valueOf(row, axis);
    return [nameOf(axis).toLowerCase(), typeof value === "number" ? number(value, 6) : value,
      unitOf(axis)].filter(Boolean).join(" ");
  }).join(", ");
}

/** @param {Api.Row} row */
const linkTo = ({ job_id: id }) => h("a", { class: "unbroken", href: routeTo("jobs", id) }, `job …${id.slice(-5)}`);

/// Time of a value, where the job tells one.
/** @param {Api.Row} row  @param {string} metric */
function timeOf(row, metric) {
  const time = row[timeMetricOf(metric)];
  return typeof time === "number" ? ` at ${number(time)} s of the run` : "";
}

/** @param {string} word  @param {Api.Row} row  @param {Api.Row[]} all  @param {SweepPage} sweep */
function extremeSentence(word, row, all, { axes, view: { metric } }) {
  const setting = settingOf(row, axes);
  const equal = all.filter((each) => each[metric] === row[metric]).length;
  return h("li", {}, `${word}: `, h("strong", {}, term("metrics", metric, withUnit(row[metric], metric))),
    timeOf(row, metric),
    setting ? `, ${setting} (` : " (", linkTo(row), equal > 1
      ? `, the first of ${equal.toLocaleString("en")} with this value)` : ")");
}

/** @param {SweepPage} sweep */
function failureSentence({ rows, failures }) {
  const failed = rows.filter(({ state }) => state === "failed");
  if (failed.length === 0) return null;
  const counts = new Map();
  for (const { job_id: id } of failed) {
    const reason = failures.of(id)?.error_reason;
    if (reason) counts.set(reason, (counts.get(reason) ?? 0) + 1);
  }
  const reasons = [...counts].sort((a, b) => b[1] - a[1]).map(([reason,
    count]) => `${count.toLocaleString("en")} by ${reason}`).join(", ");
  return h("li", { class: "failed" },
    `${plural(failed.length, "job")} of ${rows.length.toLocaleString("en")} failed${reasons ? `: ${reasons}` : ""}.`);
}

/// Sets of replicates with two values at least.
/** @param {SweepPage} sweep */
function replicateSets({ rows, axes, view: { metric } }) {
  /** @type {Map<string, Api.Row[]>} */
  const sets = new Map();
  for (const row of rows) {
    if (row.replicate === undefined || typeof row[metric] !== "number") continue;
    const key = JSON.stringify(axes.map((axis) => valueOf(row, axis)));
    const set = sets.get(key) ?? [];
    sets.set(key, set);
    set.push(row);
  }
  return [...sets.values()].filter((set) => set.length > 1);
}

/** @param {SweepPage} sweep */
function scatterSentence(sweep) {
  const { axes, view: { metric } } = sweep;
  const sets = replicateSets(sweep);
  if (sets.length === 0) return h("li", { class: "quiet" },
    "One run each: how much the values scatter is not known.");
  const spreads = sets.map((set) => {
    const values = set.map((row) => row[metric]);
    const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
    const range = Math.max(...values) - Math.min(...values);
    return { row: set[0], count: set.length, range, part: mean === 0 ? 0 : range / Math.abs(mean) };
  });
  const widest = spreads.reduce((best, each) => (each.part > best.part ? each : best));
  const middle = spreads.map(({ part }) => part).sort((a, b) => a - b)[Math.floor(spreads.length / 2)];
  const percent = (part) => `${number(100 * part, 2)} %`;
  return h("li", {}, `Replicates of ${plural(sets.length, "setting")} differ by at most `,
    h("strong", {}, percent(widest.part)),
    ` of their mean (${withUnit(widest.range, metric)}, ${plural(widest.count, "run")}, ${settingOf(widest.row, axes)}, `,
    linkTo(widest.row), `); by ${percent(middle)} in the middle of the settings.`);
}

/// Fills the list. @param list  its element
/** @param {HTMLElement} list  @param {SweepPage} sweep */
export function drawHeadlines(list, sweep) {
  const { rows, view: { metric } } = sweep;
  const all = rows.filter((row) => typeof row[metric] === "number");
  const sentences = [];
  if (all.length > 0) {
    const largest = all.reduce((best, row) => (row[metric] > best[metric] ? row : best));
    const least = all.reduce((best, row) => (row[metric] < best[metric] ? row : best));
    sentences.push(extremeSentence(`Largest ${nameOf(metric).toLowerCase()}`, largest, all, sweep));
    if (least[metric] < largest[metric]) sentences.push(extremeSentence("Least", least, all, sweep));
    if (rows.length > 1) sentences.push(scatterSentence(sweep));
  }
  list.replaceChildren(...[...sentences, failureSentence(sweep)].filter((sentence) => sentence !== null));
  list.hidden = !list.hasChildNodes();
}
