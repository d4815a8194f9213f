// SPDX-License-Identifier: Apache-2.0
// The rows of a sweep, grouped by its axes.

const notMetrics = new Set(["job_id", "state", "replicate", "replicates"]);

/** @type {(metric: string) => boolean} */
const isTime = (metric) => metric.endsWith("_time_s");

/// The columns of the rows that are numbers of the result, times of peaks behind the others.
/** @param {Api.Row[]} rows  @param {string[]} axes */
export function metricsOf(rows, axes) {
  const columns = new Set(rows.slice(0, 50).flatMap((row) => Object.keys(row)));
  return [...columns].filter((column) => !notMetrics.has(column) && !column.startsWith("replicates_")
    && !axes.includes(column)).sort((a, b) => Number(isTime(a)) - Number(isTime(b)));
}

/// The metric that a page shows first: of a described linkage the first acceleration that no drive prescribes and that
/// differs between the jobs, else the first such metric, else the first one.
/** @param {string[]} metrics  @param {Api.Row[]} rows  @param {Api.Sweep} sweep  @returns {string} */
export function usualMetric(metrics, rows, { request }) {
  const linkage = request?.parameters?.linkage;
  if (typeof linkage !== "object") return metrics[0];
  const free = metrics.filter((metric) => !drivenCoordinates(linkage).some((name) => metric.includes(`_${name}_accel`)));
  const varying = free.filter((metric) => !isTime(metric) && varies(rows, metric));
  return varying.find((metric) => metric.includes("_acceleration_")) ?? varying[0] ?? free[0] ?? metrics[0];
}

/// Coordinates that move by a law.
/** @param {any} linkage  @returns {string[]} */
function drivenCoordinates({ joints = {} }) {
  return Object.entries(joints).flatMap(([name, joint]) => [[name, joint],
    ...Object.entries(joint.freedoms ?? {}).map(([part, freedom]) => [`${name}_${part}`, freedom])])
    .filter(([, freedom]) => freedom.drive?.law).map(([name]) => name);
}

/** @param {Api.Row[]} rows  @param {string} metric */
function varies(rows, metric) {
  const values = rows.map((row) => row[metric]).filter((value) => typeof value === "number");
  const [least, largest] = [Math.min(...values), Math.max(...values)];
  return largest - least > 1e-9 * Math.max(Math.abs(least), Math.abs(largest));
}

/// Sign for a missing value.
export const none = "–";

function compare(a, b) {
  return typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en");
}

/** @type {WeakMap<Api.Row[], Map<string, any>>} */
const known = new WeakMap();  // by rows, then by name

/// Answer to a question about rows. It is found once for the same rows: many parts of a page ask the same.
/// @param name  of the question
/**
 * @template Found
 * @param {Api.Row[]} rows
 * @param {string} name
 * @param {() => Found} find
 * @returns {Found}
 */
export function onceFor(rows, name, find) {
  const ofRows = known.get(rows) ?? new Map();
  known.set(rows, ofRows);
  if (!ofRows.has(name)) ofRows.set(name, find());
  return ofRows.get(name);
}

/// The different values of an axis: numbers from the least to the largest, anything else in the order that
/// was asked for, which is that of the jobs. An object or list stands as its JSON; a missing value is the last one.
/** @param {Api.Row[]} rows  @param {string} axis */
export function valuesOf(rows, axis) {
  return onceFor(rows, `values of ${axis}`, () => inOrder([...new Set(rows.map((row) => valueOf(row, axis)))]));
}

/// True of a column that has a number in some row. The values need not be sorted for that.
/** @param {Api.Row[]} rows  @param {string} column */
export function hasNumbers(rows, column) {
  return onceFor(rows, `numbers in ${column}`, () => rows.some((row) => typeof row[column] === "number"));
}

/** @param {(string | number)[]} values */
function inOrder(values) {
  const given = values.filter((value) => value !== none);
  const sorted = given.every((value) => typeof value === "number") ? given.sort(compare) : given;
  return given.length < values.length ? [...sorted, none] : sorted;
}

/// True of an axis whose values are numbers and differ: one with a scale.
/** @param {Api.Row[]} rows  @param {string} axis */
export function hasScale(rows, axis) {
  const values = valuesOf(rows, axis).filter((value) => value !== none);
  return values.length > 1 && values.every((value) => typeof value === "number");
}

/** @param {Api.Row} row  @param {string} axis  @returns {string | number} */
export function valueOf(row, axis) {
  const value = row[axis];
  return value !== null && typeof value === "object" ? JSON.stringify(value) : value ?? none;
}

/// Mean and extremes of a metric over each set of rows that agree in the keys.
/// @returns  a list of {values, jobs, count, mean, min, max}; rows without the metric count for nothing but are
/// among the jobs
/** @param {Api.Row[]} rows  @param {string[]} keys  @param {string} metric  @returns {Group[]} */
export function groupBy(rows, keys, metric) {
  /** @type {(Group & { sum: number })[]} */
  const groups = [];
  const tree = new Map();  // by the value of each key in turn; in the leaves the groups
  for (const row of rows) {
    const values = keys.map((key) => valueOf(row, key));
    const leaf = values.reduce((node, value) => childOf(node, value), tree);
    let group = leaf.get(leafName);
    if (!group) {
      group = { values, jobs: [], count: 0, sum: 0, min: Infinity, max: -Infinity, mean: null };
      leaf.set(leafName, group);
      groups.push(group);
    }
    group.jobs.push(row.job_id);
    const value = row[metric];
    if (typeof value !== "number") continue;
    group.count += 1;
    group.sum += value;
    group.min = Math.min(group.min, value);
    group.max = Math.max(group.max, value);
  }
  for (const group of groups) if (group.count > 0) group.mean = group.sum / group.count;
  return groups;
}

const leafName = Symbol("group");

/** @param {Map<any, any>} node  @param {string | number} value  @returns {Map<any, any>} */
function childOf(node, value) {
  let child = node.get(value);
  if (!child) node.set(value, child = new Map());
  return child;
}

/// The axes that a chart does not draw, so that what differs in them lies together in its points; replicates, too.
/** @param {Group[]} groups  @param {Pick<SweepPage, "rows" | "axes" | "view">} sweep */
export function averagedAxes(groups, { rows, axes, view }) {
  if (!groups.some((group) => group.count > 1)) return [];
  const drawn = [view.x, view.y, view.panel];
  return [...axes, "replicate"].filter((axis) => !drawn.includes(axis) && valuesOf(rows, axis).length > 1);
}

/// Rows in the order of a column; those without a value stand last either way.
/** @param {Api.Row[]} rows  @param {string} column  @param {boolean} descending */
export function sortedBy(rows, column, descending) {
  const has = (row) => row[column] !== null && row[column] !== undefined;
  const filled = rows.filter(has).sort((a, b) => compare(valueOf(a, column), valueOf(b, column)));
  return [...(descending ? filled.reverse() : filled), ...rows.filter((row) => !has(row))];
}
