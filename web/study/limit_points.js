// SPDX-License-Identifier: Apache-2.0
// The evaluations of one combination: the metric over the parameter, with the spread of the replicates, the bound
// and the limit.
import { axisLook, makeChart } from "/core/charts.js";
import { nameOf, number, titleOf, unitOf } from "/core/format.js";
import { colour, lineColour } from "/core/theme.js";
import { bars } from "/analysis/parts.js";
import { fallsShown, hasReplicates } from "/study/limit_curve.js";

/**
 * @param {HTMLElement} element
 * @param {import("/study/limit_view.js").LimitView} view
 * @param {AbortSignal} signal
 */
export function limitPoints(element, view, signal) {
  return makeChart(element, () => optionOf(view.study, view.study.limits[view.shown]),
    "The metric at each evaluated value, with its bound", signal);
}

/** @param {Api.Search} search  @param {Api.Limit} limit */
function optionOf(search, limit) {
  const points = limit.points.filter((point) => point.quantile !== null);
  if (points.length === 0) return null;
  const { scale } = search.request.over[search.parameter];
  const fallen = fallsShown(search, limit).map(({ from, to }) =>
    [{ xAxis: Math.min(from, to), itemStyle: hasReplicates(search) ? { color: colour("bad"), opacity: 0.12 }
      : { color: colour("quiet"), opacity: 0.15 } }, { xAxis: Math.max(from, to) }]);
  return {
    grid: { left: 75, right: 30, top: 30, bottom: 50 },
    tooltip: { formatter: ({ dataIndex, seriesIndex }) => (seriesIndex < 2 ? textOf(search, points[dataIndex]) : "") },
    xAxis: { type: scale === "log" ? "log" : "value", scale: true, name: titleOf(search.parameter),
      nameLocation: "middle", nameGap: 28, ...axisLook() },
    yAxis: { type: "value", scale: true, name: titleOf(search.metric), nameLocation: "middle", nameGap: 50,
      ...axisLook(), axisLabel: { color: colour("text"), showMinLabel: false, showMaxLabel: false,
        formatter: (value) => number(value) }, max: ({ max }) => Math.max(max, search.bound),
        min: ({ min }) => Math.min(min, search.bound) },
    series: [{ ...bars(lineColour(0), points.map(({ value, min, max }) => [value, min, max])),
      silent: false },
      { type: "line", color: lineColour(0), symbol: "circle", symbolSize: 8,
        data: points.map((point) => [point.value, point.quantile]), z: 3,
      markArea: { silent: true, data: fallen },
      markLine: { symbol: "none", silent: true, lineStyle: { color: lineColour(1), type: "dashed" },
        label: { position: "insideEndTop", color: colour("text"), formatter: ({ data }) => data.name },
        data: [{ yAxis: search.bound, name: "bound" },
          ...(limit.verdict === "found" ? [{ xAxis: limit.limit, name: "limit" }] : [])] } }],
  };
}

/** @param {Api.Search} search  @param {Api.Schemas["SearchPoint"]} point */
function textOf(search, point) {
  const unit = unitOf(search.metric);
  const { part_within_low: low, part_within_high: high } = point;
  const share = low === null || high === null ? ""
    : `: ${number(100 * low, 3)} to ${number(100 * high, 3)} % of all, with 90 % confidence`;
  const where = `${nameOf(search.parameter)} ${number(point.value)} ${unitOf(search.parameter)}`;
  if (point.count < 2) return [where, `${number(point.quantile)} ${unit}, one run`,
    point.within === point.count ? "within the bound"
    : "beyond the bound"].join("\n");
  return [where,
    `quantile ${number(point.quantile)} ${unit}`, `${number(point.min)} to ${number(point.max)} ${unit}`,
    `${point.within} of ${point.count} within the bound${share}`].join("\n");
}
