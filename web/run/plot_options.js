// SPDX-License-Identifier: Apache-2.0
// Options of a plot over time for uPlot: look, and response to the pointer.
import { number, unitOf } from "/core/format.js";
import { colour, isDark } from "/core/theme.js";
import { columnsOf } from "/run/plot_data.js";

/**
 * @param {Trace[]} traces
 * @param {TimeWindow} times
 * @param {number} width
 * @param {number} height
 * @returns {any}
 */
export function plotOptions(traces, times, width, height) {
  const units = [...new Set(traces.map((trace) => unitOf(trace.channel) || "1"))];
  return {
    width, height,
    scales: { x: { time: false, range: () => [times.from, times.to] } },
    series: [{ label: "t [s]", value: (_, value) => number(value, 6) },
      ...traces.flatMap((trace) => seriesOf(trace, units.length === 1))],
    bands: bandsOf(traces),
    axes: [axis("x", "t [s]", 3), ...units.map((unit, index) => axis(unit, unit, index === 0 ? 3 : 1))],
    cursor: { sync: { key: "time" }, drag: { x: true, y: false, setScale: false }, bind: {
      dblclick: () => () => { times.reset(); return null; },
      // Dragging with Shift moves the window: that is not a selection.
      mousedown: (_, __, handle) => (event) => { if (!event.shiftKey) handle(event); return null; },
    } },
    hooks: {
      setSelect: [(plot) => zoomToSelection(plot, times)],
      setCursor: [(plot) =>
        { if (plot.cursor.left >= 0 && plot.cursor.event) times.pointAt(plot.posToVal(plot.cursor.left, "x")); }],
    },
  };
}

function zoomToSelection(plot, times) {
  const { left, width } = plot.select;
  if (width < 3) return;
  const [from, to] = [plot.posToVal(left, "x"), plot.posToVal(left + width, "x")];
  plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  times.set(from, to);
}

/// The curve and the ends of its envelope, which the legend does not list.
/** @param {Trace} trace  @param {boolean} isPlain  whether one unit, in the title, counts for all numbers */
function seriesOf(trace, isPlain) {
  const unit = unitOf(trace.channel);
  const common = { scale: unit || "1", stroke: trace.colour(), points: { show: false },
    value: (_, value) => (value === null || value === undefined ? "–"
      : isPlain ? number(value) : `${number(value)} ${unit}`) };
  return columnsOf(trace).map((column) => (column === trace.channel
    ? { ...common, label: trace.name, width: 1.3, dash: trace.dash }
    : { ...common, label: `${trace.name}, ${column === trace.envelope?.[0] ? "least" : "largest"}`,
      width: 0.7, class: "twin" }));
}

/// The envelope is filled between its two columns.
/** @param {Trace[]} traces */
function bandsOf(traces) {
  let at = 1;
  return traces.flatMap((trace) => {
    const low = at;
    at += columnsOf(trace).length;
    return trace.envelope ? [{ series: [low + 1, low], fill: `${trace.colour()}55` }] : [];
  });
}

function axis(scale, label, side) {
  const x = scale === "x";
  const grid = { stroke: isDark() ? "#ffffff18" : "#00000014", width: 1, show: side === 3 };
  return { scale, label, side: x ? 2 : side, stroke: colour("text"), labelSize: 18, size: x ? 38 : 64,
    font: "12px system-ui", labelFont: "12px system-ui", grid, ticks: grid,
    values: (_, values) => values.map((value) => (value === null ? "" : number(value, 6))) };
}
