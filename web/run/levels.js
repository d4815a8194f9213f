// SPDX-License-Identifier: Apache-2.0
// Levels in a plot: the peaks of the metrics, which samples may miss, as dotted lines at both signs of the
// magnitude.
import { unitOf } from "/core/format.js";

const dots = [2, 4];

/** @type {(trace: Trace) => string} */
const scaleOf = (trace) => unitOf(trace.channel) || "1";

/// Range of a scale: that of the data, and of the levels while the whole run is shown.
/**
 * @param {Trace[]} traces
 * @param {TimeWindow} times
 * @param {string} scale
 * @param {(low: number, high: number, pad: number, soft: boolean) => number[]} rangeOf  uPlot's own
 */
export function rangeWith(traces, times, scale, rangeOf) {
  const levels = traces.filter((trace) => scaleOf(trace) === scale).map(({ level = 0 }) => level);
  const largest = Math.max(...levels);
  return (_, low, high) => {
    if (low === null || high === null) return [null, null];
    if (!times.isWhole || largest === 0) return rangeOf(low, high, 0.1, true);
    return rangeOf(low < 0 ? Math.min(low, -largest) : low, Math.max(high, largest), 0.1, true);
  };
}

/// Draws the levels that lie within the plot.
/** @param {Trace[]} traces */
export function levelsHook(traces) {
  return (plot) => {
    const { ctx, bbox: { left, top, width, height } } = plot;
    const drawn = traces.flatMap((trace) => (trace.level ? [trace.level, -trace.level].map((level) =>
      ({ trace, level, y: plot.valToPos(level, scaleOf(trace), true) })) : []))
      .filter(({ y }) => y >= top && y <= top + height);
    plot.root.dataset.levels = drawn.map(({ level }) => level).join(" ");
    ctx.save();
    ctx.setLineDash(dots.map((length) => length * devicePixelRatio));
    ctx.lineWidth = devicePixelRatio;
    for (const { trace, y } of drawn) {
      ctx.strokeStyle = trace.colour();
      ctx.beginPath();
      ctx.moveTo(left, y);
      ctx.lineTo(left + width, y);
      ctx.stroke();
    }
    ctx.restore();
  };
}
