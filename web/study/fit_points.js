// SPDX-License-Identifier: Apache-2.0
// Points of a fit in the order in which they were tried: their sums of squares, and the values of the best so
// far.
import { axisLook, makeChart, nothingYet, numberLook } from "/core/charts.js";
import { number } from "/core/format.js";
import { colour, lineColour } from "/core/theme.js";
import { legendOf } from "/study/legend.js";
import { nameOfVariable, titleOfVariable, unitOfVariable } from "/study/variables.js";

/** @typedef {Api.Schemas["FitPointRows"][number] & { point: number, stage: string }} Point */

/// Index of the best point among the first ones, for each of the points; only points with a sum of squares
/// count.
/** @param {Point[]} points */
export function runningBest(points) {
  let best = 0;
  return points.map((point, index) => {
    if (Number(point.sum_of_squares) < Number(points[best].sum_of_squares)) best = index;
    return points[best];
  });
}

/// Points with a sum of squares.
/** @param {import("/study/fit_view.js").FitView} view */
export const computed = ({ points }) => points.filter(({ sum_of_squares: sum }) => typeof sum === "number");

const none = () => nothingYet("", "No point has a value.");
const pointAxis = () => ({ type: "value", name: "point", nameLocation: "middle", nameGap: 28, minInterval: 1,
  ...axisLook() });
const grid = { left: 75, right: 20, top: 44, bottom: 50 };

/// Values of a fit's variables over its points.
/**
 * @param {HTMLElement} element
 * @param {import("/study/fit_view.js").FitView} view
 * @param {AbortSignal} signal
 */
export function fitConvergence(element, view, signal) {
  return makeChart(element, () => {
    const points = computed(view);
    if (points.length === 0) return none();
    return view.shownVariable ? valueOption(view, points, view.shownVariable)
      : shareOption(view, points, element.clientWidth);
  }, "Best values over the points of the fit; the table below has the last ones", signal);
}

/// Sums of squares over the points of a fit.
/**
 * @param {HTMLElement} element
 * @param {import("/study/fit_view.js").FitView} view
 * @param {AbortSignal} signal
 */
export function fitMisfit(element, view, signal) {
  return makeChart(element, () => {
    const points = computed(view);
    if (points.length === 0) return none();
    return { grid, legend: { top: 0 }, tooltip: { formatter: textOfPoint },
      xAxis: pointAxis(),
      yAxis: { type: "log", name: "sum of squares", nameLocation: "middle", nameGap: 55, ...numberLook() },
      series: [tried(points, (point) => point.sum_of_squares),
        { type: "line", step: "end", symbol: "none", name: "best so far", color: lineColour(0),
          data: runningBest(points).map((best, index) => [points[index].point, best.sum_of_squares]) }] };
  }, "Sum of squares over the points of the fit", signal);
}

const textOfPoint = ({ seriesName, value: [point, value, stage = ""] }) =>
  `${seriesName}\npoint ${point}${stage ? `, ${stage}` : ""}: ${number(value, 5)}`;

/// Marks of all points. @param valueOfPoint  its height
function tried(points, valueOfPoint) {
  return { type: "scatter", name: "points", symbolSize: 4, itemStyle: { color: colour("quiet"),
    opacity: 0.45 },
    large: points.length > 2000,
      data: points.map((point) => [point.point, valueOfPoint(point), point.stage]) };
}

/// All variables in one chart, each as a part of the way between its bounds.
/** @param {import("/study/fit_view.js").FitView} view  @param {Point[]} points  @param {number} width */
function shareOption(view, points, width) {
  const best = runningBest(points);
  const legend = legendOf(view.study.parameters.map(({ path }) => nameOfVariable(path)), width);
  const series = view.study.parameters.map(({ path }, index) =>
    ({ type: "line", step: "end", symbol: "none", name: nameOfVariable(path), color: lineColour(index),
      data: best.map((each, at) => [points[at].point, 100 * view.partOf(path, Number(each[path]))]) }));
  return { grid: { ...grid, top: 20 + legend.height }, legend: legend.option, xAxis: pointAxis(),
    tooltip: { trigger: "axis", formatter: (lines) =>
    [`point ${lines[0].value[0]}`,
      ...lines.map(({ seriesName, value }) => `${seriesName}: ${number(value[1])} %`)]
      .join("\n") },
  yAxis: { type: "value", min: 0, max: 100, name: "best so far, from lower to upper bound [%]",
    nameLocation: "middle", nameGap: 50, ...axisLook() }, series };
}

/// One variable in its unit, with its interval as a band.
/** @param {import("/study/fit_view.js").FitView} view  @param {Point[]} points  @param {string} path */
function valueOption(view, points, path) {
  const parameter = view.study.parameters.find((each) => each.path === path);
  const interval = parameter?.profile ?? parameter?.range ?? parameter?.linearised;
  const unit = unitOfVariable(path);
  const band = interval && interval.low !== null && interval.high !== null
    ? { silent: true, itemStyle: { color: lineColour(0), opacity: 0.25 },
      data: [[{ yAxis: interval.low }, { yAxis: interval.high }]] } : undefined;
  return { grid, legend: { top: 0 },
    tooltip: { formatter: (item) => `${textOfPoint(item)}${unit ? ` ${unit}` : ""}` }, xAxis: pointAxis(),
    yAxis: { type: view.isLog(path) ? "log" : "value", scale: true, name: titleOfVariable(path),
      nameLocation: "middle", nameGap: 55, ...axisLook() },
    series: [tried(points, (point) => point[path]),
      { type: "line", step: "end", symbol: "none", name: "best so far", color: lineColour(0), markArea: band,
        data: runningBest(points).map((best, index) => [points[index].point, best[path]]) }] };
}
