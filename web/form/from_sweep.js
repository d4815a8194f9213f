// SPDX-License-Identifier: Apache-2.0
// Beginnings of requests for fits and optimisations, from a sweep or a measurement.
import { findMeasurement, findSweep, listMeasurements } from "/core/api.js";

const sizes = (axis) => (Array.isArray(axis) ? axis : [axis.from, axis.to]);

/// Bounds of an axis; null of words, whole numbers of elements, and single values.
/** @param {any} axis */
function boundsOf(axis) {
  const values = sizes(axis);
  if (!values.every((value) => typeof value === "number")) return null;
  const [from, to] = [Math.min(...values), Math.max(...values)];
  return from < to ? { from, to, ...(axis.scale === "log" ? { scale: "log" } : {}) } : null;
}

/// Parameters, variables and remaining axes of a sweep.
/** @param {string} id  @param {AbortSignal} signal */
async function partsOf(id, signal) {
  const { request, name } = await findSweep(id, signal);
  const axes = { ...request.sweep, ...request.design?.over };
  const over = {};
  const rest = {};
  for (const [path, axis] of Object.entries(axes)) {
    const bounds = /elements$|levels$/.test(path) ? null : boundsOf(axis);
    if (bounds) over[path] = bounds;
    else rest[path] = axis;
  }
  return { name: name || id, parameters: request.parameters ?? {}, over, rest };
}

const usualVariables = { clearance_mm: { from: 0.05, to: 0.5 } };
const orUsual = (over) => (Object.keys(over).length > 0 ? over : usualVariables);

/// A request for the optimisation of a metric over the ranges of a sweep; axes of words stay axes.
/** @param {URLSearchParams} query  @param {any} example  @param {AbortSignal} signal */
export async function optimisationFrom(query, example, signal) {
  const id = query.get("sweep");
  if (!id) return example;
  const { name, parameters, over, rest } = await partsOf(id, signal);
  return { name: `Optimisation of ${name}`, parameters, over: orUsual(over), sweep: rest,
    objectives: [{ metric: query.get("metric") ?? example.objectives[0].metric }] };
}

/// A request for a fit over the ranges of a sweep, or to a measurement; else to the last measurement.
/** @param {URLSearchParams} query  @param {AbortSignal} signal */
export async function fitFrom(query, signal) {
  const [sweep, measurement] = [query.get("sweep"), query.get("measurement")];
  const chosen = measurement ? [await findMeasurement(measurement, signal)]
    : (await listMeasurements({ limit: 1 }, signal)).items;
  const measurements = chosen.map(({ id }) => ({ id }));
  if (!sweep) return { name: chosen.map(({ name }) => `Fit of ${name}`).join(), over: usualVariables,
    measurements };
  const { name, parameters, over, rest } = await partsOf(sweep, signal);
  const fixed = Object.entries(rest).map(([path, axis]) => [path, sizes(axis)[0]]);
  // These follow from the samples.
  /** @type {(entry: any[]) => boolean} */
  const isFree = ([path]) => path !== "duration_s" && path !== "output_rate_hz";
  return { name: `Fit of ${name}`, measurements,
    parameters: Object.fromEntries([...Object.entries(parameters), ...fixed].filter(isFree)),
    over: orUsual(Object.fromEntries(Object.entries(over).filter(isFree))) };
}
