// SPDX-License-Identifier: Apache-2.0
// The limit over the first numeric axis, a line for each combination of the others; between "all within" and "none
// within" the band. Where there is no limit, the line has a gap and the foot of the chart a cross.
import { axisLook, makeChart } from "/core/charts.js";
import { nameOf, number, plural, pointOf, titleOf } from "/core/format.js";
import { lineColour } from "/core/theme.js";

/// True of a search whose values were run more than once: only then are there quantiles and bands.
/** @param {Api.Search} search */
export const hasReplicates = ({ request }) => Number(request.replicates?.count ?? 1) > 1;

/// Stretches in which the metric falls. Single runs scatter too much to tell of one, except where the bound
/// holds again.
/** @param {Api.Search} search  @param {Api.Limit} limit */
export const fallsShown = (search, { falls }) =>
  falls.filter((fall) => hasReplicates(search) || fall.within_again);

/** @type {Record<Api.Limit["verdict"], string>} */
const verdicts = { open: "open", found: "found", never_exceeded: "not exceeded at",
  always_exceeded: "exceeded from the start", lost: "undetermined: a job has no value" };

/// Verdict on a limit; "not exceeded" with the number of values at which that was looked at.
/** @type {(limit: Api.Limit) => string} */
export const verdictOf = ({ verdict, lost_reason: reason, points }) =>
  verdicts[verdict] + (verdict === "never_exceeded"
    ? ` ${points.length === 1 ? "the value" : `any of the ${points.length} values`} looked at` : "")
  + (reason === "no_value" ? " (the metric does not apply)" : reason ? ` (${reason})` : "");

/**
 * @param {HTMLElement} element
 * @param {import("/study/limit_view.js").LimitView} view
 * @param {AbortSignal} signal
 */
export function limitCurve(element, view, signal) {
  return makeChart(element, () => optionOf(view.study),
    "The limit over an axis; the table below has the same numbers", signal);
}

/** @param {Api.Search} search */
function optionOf(search) {
  if (search.limits.every(({ limit }) => limit === null)) return null;
  const drawn = [...search.limits];
  const numeric = search.axes.find((axis) => drawn.every((limit) => typeof limit[axis] === "number"));
  const x = numeric ?? search.axes[0];
  if (numeric) drawn.sort((a, b) => a[numeric] - b[numeric]);
  const at = (limit) => (x ? limit[x] : search.name || "limit");
  const others = search.axes.filter((axis) => axis !== x);
  /** @type {Map<string, Api.Limit[]>} */
  const lines = new Map();
  for (const limit of drawn) {
    const name = others.map((axis) => pointOf(axis, limit[axis])).join(", ") || nameOf(search.parameter);
    lines.set(name, [...(lines.get(name) ?? []), limit]);
  }
  const axis = numeric ? { type: "value", scale: true }
    : { type: "category", data: [...new Set(drawn.map(at))].map(String) };
  return {
    grid: { left: 75, right: 20, top: 40, bottom: 50 },
    legend: { top: 0, show: others.length > 0 },
    tooltip: { formatter: ({ seriesIndex, dataIndex }) =>
      textOf(search, [...lines.values()][Math.floor(seriesIndex / 2)][dataIndex]) },
    xAxis: { ...axis, name: x ? titleOf(x) : "", nameLocation: "middle", nameGap: 28, ...axisLook() },
    yAxis: { type: "value", scale: true, name: titleOf(search.parameter), nameLocation: "middle", nameGap: 50,
      ...axisLook() },
    series: [...lines].flatMap(([name, limits], index) => [bandSeries(name, limits, index, at,
      hasReplicates(search)),
      lineSeries(name, limits, index, at)]),
  };
}

/// Line of the limits. A limit that was not exceeded lies beyond its point, which is drawn hollow.
function lineSeries(name, limits, index, at) {
  return { name, type: "line", color: lineColour(index), symbolSize: 9, z: 3,
    data: limits.map((limit) =>
      ({ value: [at(limit), limit.limit ?? "-"], symbol: limit.verdict === "found" ? "circle" : "emptyTriangle" })) };
}

/// Bar beside a limit: the band between "all replicates" and "none", or the stretch in which the limit of
/// single runs lies. A cross where a search has ended without a limit.
function bandSeries(name, limits, index, at, isBand) {
  const endsOf = (limit) => (isBand ? [limit.band_from ?? limit.limit, limit.band_to ?? limit.limit_beyond
    ?? limit.limit]
    : [limit.limit, limit.limit_beyond ?? limit.limit]);
  return { name, type: "custom", color: lineColour(index),
    data: limits.map((limit) => [at(limit), ...endsOf(limit)]), encode: { x: 0, y: [1, 2] },
    renderItem: ({ coordSys, dataIndex }, api) => {
      const [x, low] = api.coord([api.value(0), api.value(1)]);
      const { limit, verdict } = limits[dataIndex];
      if (limit === null) return verdict === "open" ? null : { type: "text", x, y: coordSys.y + coordSys.height,
        style: { text: "×", fill: api.visual("color"), font: "20px system-ui", align: "center", verticalAlign: "bottom" } };
      const [, high] = api.coord([api.value(0), api.value(2)]);
      return { type: "rect", shape: { x: x - 6, y: high, width: 12, height: low - high },
        style: { fill: api.visual("color"), opacity: 0.3 } };
    } };
}

/** @param {Api.Search} search  @param {Api.Limit} limit */
function textOf(search, limit) {
  const where = search.axes.map((axis) => pointOf(axis, limit[axis])).join(", ");
  if (limit.limit === null) return `${where}\n${verdictOf(limit)}`;
  const beyond = limit.limit_beyond === null
    ? `not exceeded at any of ${plural(limit.points.length, "value")} up to there`
    : `exceeded at ${number(limit.limit_beyond)}`;
  const band = hasReplicates(search)
    ? `OK in all replicates up to ${number(limit.band_from)}, exceeded in all from ${number(limit.band_to)}`
      : "one run at each value";
  return [where, `${nameOf(search.parameter)} ${number(limit.limit)}, ${beyond}`, band,
    limit.monotonic || !hasReplicates(search) ? "" : "the metric is not monotonic"].filter(Boolean)
    .join("\n");
}
