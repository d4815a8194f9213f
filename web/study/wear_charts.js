// SPDX-License-Identifier: Apache-2.0
// The bore of a wear study around the bearing, a curve for some of its cycles; and its largest depth over the hours.
import { depthAxis } from "/analysis/polar.js";
import { axisLook, makeChart } from "/core/charts.js";
import { number } from "/core/format.js";
import { colour, lineColour } from "/core/theme.js";

const mostCurves = 8;

/**
 * @param {HTMLElement} element
 * @param {import("/study/wear_view.js").WearView} view
 * @param {AbortSignal} signal
 */
export function wearMap(element, view, signal) {
  return makeChart(element, () => mapOption(view.study.cycles, view.ring, element.clientWidth),
    "Worn depth around the bearing after some of the cycles", signal);
}

/**
 * @param {HTMLElement} element
 * @param {import("/study/wear_view.js").WearView} view
 * @param {AbortSignal} signal
 */
export function wearGrowth(element, view, signal) {
  return makeChart(element, () => growthOption(view.study.cycles),
    "Maximum depth and rate over time; the table below has the same numbers", signal);
}

/// The first is round; the last and some between, evenly.
/** @param {Api.WearStudy["cycles"]} cycles */
function chosen(cycles) {
  const count = Math.min(mostCurves, cycles.length - 1);
  const places = Array.from({ length: count }, (_, k) => Math.round(((k + 1) * (cycles.length - 1)) / count));
  return [...new Set(places)].map((place) => cycles[place]);
}

/// 0 degrees, the bearing's x, points right, and angles go against the clock; the circle in the middle is the bore
/// as it was new.
/** @param {Api.WearStudy["cycles"]} cycles  @param {number} ring  @param {number} width */
function mapOption(cycles, ring, width) {
  if (cycles.length < 2) return null;
  const text = { color: colour("text") };
  const curve = (depths) => [...depths, depths[0]].map((depth, s) => [depth, (360 * (s + 0.5)) / depths.length]);
  const drawn = chosen(cycles);
  return {
    ...depthAxis(Math.max(...drawn.flatMap((cycle) => cycle.wear_depth_um[ring])), width),
    legend: { top: 0, type: "scroll" }, polar: { radius: ["25%", "78%"] },
    tooltip: { formatter: (
      { seriesName, value }) => `${seriesName}\n${number(value[1] % 360, 3)}°: ${number(value[0])} µm` },
    angleAxis: { type: "value", min: 0, max: 360, interval: 30, startAngle: 0, clockwise: false,
      axisLabel: { ...text, formatter: (angle) => (angle === 360 ? "" : `${angle}°`) },
      axisLine: { lineStyle: { color: colour("quiet") } } },
    series: drawn
      .map((cycle, index) =>
        ({ type: "line", coordinateSystem: "polar", name: `${number(cycle.hours, 3)} h`, color: lineColour(index),
          symbolSize: 3, data: curve(cycle.wear_depth_um[ring]) })),
  };
}

/** @param {Api.WearStudy["cycles"]} cycles */
function growthOption(cycles) {
  if (cycles.length < 2) return null;
  /** @type {(key: keyof Api.Schemas["WearCycle"], name: string, index: number, axis: number) => object} */
  const line = (key, name, index, axis) =>
    ({ type: "line", name, color: lineColour(index), yAxisIndex: axis, symbolSize: 6,
      data: cycles.map((cycle) => [cycle.hours, cycle[key]]) });
  const scale = (name) => ({ type: "value", min: 0, name, nameLocation: "middle", nameGap: 50, ...axisLook() });
  return {
    grid: { left: 75, right: 75, top: 40, bottom: 50 }, legend: { top: 0 },
    tooltip: { formatter: ({ seriesName, value }) => `${seriesName}\n${number(value[0])} h: ${number(value[1])}` },
    xAxis: { type: "value", name: "time [h]", nameLocation: "middle", nameGap: 28, ...axisLook() },
    yAxis: [scale("maximum depth [µm]"), { ...scale("maximum rate [µm/h]"), splitLine: { show: false } }],
    series: [line("deepest_um", "depth [µm]", 0, 0), line("rate_um_h", "rate [µm/h]", 1, 1)],
  };
}
