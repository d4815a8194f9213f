// SPDX-License-Identifier: Apache-2.0
// Signals over time below each other, as they are before they are sent.
import { axisLook, makeChart, nothingYet } from "/core/charts.js";
import { number, unitOf } from "/core/format.js";
import { lineColour } from "/core/theme.js";

const mostDrawn = 4;
const buckets = 1000;  // of samples, each of which is drawn by its smallest and its largest

/** @typedef {{ time: number[], signals: { name: string, values: number[] }[] }} Signals */

/// @param find  gives the signals, anew for each drawing
/** @param {HTMLElement} element  @param {() => Signals | null} find  @param {AbortSignal} signal */
export function previewChart(element, find, signal) {
  return makeChart(element, () => optionOf(find()), "Signals of the chosen file over time", signal);
}

/// Points of a line that keep its peaks.
/** @param {number[]} time  @param {number[]} values */
function thinned(time, values) {
  const size = Math.max(1, Math.ceil(values.length / buckets));
  if (size <= 2) return values.map((value, index) => [time[index], value]);
  const points = [];
  for (let from = 0; from < values.length; from += size) {
    let [low, high] = [from, from];
    for (let index = from; index < Math.min(from + size, values.length); index += 1) {
      if (values[index] < values[low]) low = index;
      if (values[index] > values[high]) high = index;
    }
    for (const index of low < high ? [low, high] : [high, low]) points.push([time[index], values[index]]);
  }
  return points;
}

/** @param {Signals | null} shown */
function optionOf(shown) {
  const signals = shown?.signals.slice(0, mostDrawn) ?? [];
  if (!shown || signals.length === 0) return nothingYet("", "No channel chosen.");
  const part = 90 / signals.length;
  const look = axisLook();
  const isLast = (index) => index === signals.length - 1;
  return {
    grid: signals.map((_, index) => ({ left: 75, right: 20, top: `${5 + index * part}%`,
      height: `${part - 7}%` })),
    tooltip: { trigger: "axis", formatter: (lines) => [`t ${number(lines[0].value[0], 6)} s`,
      ...lines.map(({ seriesName, value }) =>
        `${seriesName}: ${number(value[1])} ${unitOf(seriesName)}`)].join("\n") },
    axisPointer: { link: [{ xAxisIndex: "all" }] },
    xAxis: signals.map((_, index) => ({ type: "value", gridIndex: index, min: "dataMin", max: "dataMax",
      ...look,
      axisLabel: { ...look.axisLabel, show: isLast(index), formatter: (t) => number(t, 5) },
      ...(isLast(index) ? { name: "t [s]", nameLocation: "middle", nameGap: 26 } : {}) })),
    yAxis: signals.map(({ name }, index) => ({ type: "value", gridIndex: index, scale: true, splitNumber: 3,
      name: unitOf(name) ? `[${unitOf(name)}]` : "no unit", nameLocation: "middle", nameGap: 50, ...look })),
    series: signals.map(({ name, values }, index) => ({ type: "line", name, symbol: "none",
      color: lineColour(index),
      xAxisIndex: index, yAxisIndex: index, lineStyle: { width: 1.2 }, data: thinned(shown.time, values) })),
    title: signals.map(({ name }, index) => ({ text: name, left: 80, top: `${0.4 + index * part}%`,
      textStyle: { color: look.axisLabel.color, fontSize: 12, fontWeight: "normal" } })),
  };
}
