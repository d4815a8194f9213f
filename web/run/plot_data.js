// SPDX-License-Identifier: Apache-2.0
// The data of a plot: columns of several jobs and measurements on one time axis.
import { findMeasured, findTrajectory } from "/core/api.js";

const margin = 0.5;  // of the window, fetched on either side of it, so that moving shows something at once
const pointsPerPixel = 2;

/// uPlot's data for the traces: the times, then for each trace its columns (its envelope's two before its own).
/**
 * @param {any} uPlot
 * @param {Pick<Trace, "job" | "channel" | "envelope" | "measured">[]} traces
 * @param {Pick<TimeWindow, "isWhole" | "start" | "from" | "to" | "end" | "length">} times
 * @param {number} width
 * @param {AbortSignal} signal
 */
export async function loadAligned(uPlot, traces, times, width, signal) {
  const whole = times.isWhole;
  const range = whole ? {} : { from: Math.max(times.start, times.from - margin * times.length),
    to: Math.min(times.end, times.to + margin * times.length) };
  const points = Math.max(400, Math.round(pointsPerPixel * width * (whole ? 1 : 1 + 2 * margin)));
  const bySource = Map.groupBy(traces, ({ job, measured }) => JSON.stringify([job, measured]));
  const tables = await Promise.all([...bySource.values()].map(async (own) => {
    const [{ job, measured }] = own;
    const channels = [...new Set(own.flatMap(columnsOf))];
    const many = points + 2 * channels.length;
    const columns = measured ? await loadMeasured(job, measured, channels, range, many, signal)
      : await findTrajectory(job, { channels: ["t_s", ...channels], ...range, points: many }, signal);
    return { own, columns };
  }));
  // A table's columns stand in the order of the traces, whose jobs may take turns.
  const order = tables.flatMap(({ own }) =>
    own.flatMap((trace) => columnsOf(trace).map((_, index) => `${traces.indexOf(trace)}.${index}`)));
  const joined = uPlot.join(
    tables.map(({ own, columns }) =>
      [columns.t_s, ...own.flatMap((trace) => columnsOf(trace).map((column) => columns[column]))]));
  const wanted = traces.flatMap((trace, at) => columnsOf(trace).map((_, index) => `${at}.${index}`));
  return [joined[0], ...wanted.map((key) => joined[1 + order.indexOf(key)])];
}

/// Columns of a run of a measurement, corrected and at the times of the plot.
/**
 * @param {string} id
 * @param {MeasuredCurve} curve
 * @param {string[]} channels
 * @param {{ from?: number, to?: number }} range
 * @param {number} points
 * @param {AbortSignal} signal
 */
async function loadMeasured(id, { run, factor, offset, shift }, channels, range, points, signal) {
  const within = range.from === undefined || range.to === undefined ? {}
    : { from: range.from - shift, to: range.to - shift };
  const columns = await findMeasured(id, { run, channels: channels.join(","), ...within, points }, signal);
  return Object.fromEntries(Object.entries(columns).map(([name, values]) =>
    [name, values.map((value) => (name === "t_s" ? value + shift : factor * value + offset))]));
}

/** @param {Pick<Trace, "channel" | "envelope">} trace */
export function columnsOf(trace) {
  return [...(trace.envelope ?? []), trace.channel];
}
