// SPDX-License-Identifier: Apache-2.0
// The data of a plot: columns of several jobs on one time axis.
import { findTrajectory } from "/core/api.js";

const margin = 0.5;  // of the window, fetched on either side of it, so that moving shows something at once
const pointsPerPixel = 2;

/// uPlot's data for the traces: the times, then for each trace its columns (its envelope's two before its own).
/**
 * @param {any} uPlot
 * @param {Pick<Trace, "job" | "channel" | "envelope">[]} traces
 * @param {Pick<TimeWindow, "isWhole" | "from" | "to" | "end" | "length">} times
 * @param {number} width
 * @param {AbortSignal} signal
 */
export async function loadAligned(uPlot, traces, times, width, signal) {
  const whole = times.isWhole;
  const range = whole ? {} : { from: Math.max(0, times.from - margin * times.length),
    to: Math.min(times.end, times.to + margin * times.length) };
  const points = Math.max(400, Math.round(pointsPerPixel * width * (whole ? 1 : 1 + 2 * margin)));
  const byJob = Map.groupBy(traces, (trace) => trace.job);
  const tables = await Promise.all([...byJob].map(async ([job, own]) => {
    const channels = [...new Set(own.flatMap(columnsOf))];
    const columns = await findTrajectory(job,
      { channels: ["t_s", ...channels], ...range, points: points + 2 * channels.length }, signal);
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

/** @param {Pick<Trace, "channel" | "envelope">} trace */
export function columnsOf(trace) {
  return [...(trace.envelope ?? []), trace.channel];
}
