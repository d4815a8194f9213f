// SPDX-License-Identifier: Apache-2.0
// Candidates of an optimisation over two of their numbers, with the Pareto front; a click selects.
import { axisLook, makeChart, nothingYet } from "/core/charts.js";
import { number } from "/core/format.js";
import { colour, lineColour, ring } from "/core/theme.js";
import { titleOfMetric } from "/study/optimisation_answer.js";
import { fittedAxis } from "/study/span.js";

/** @typedef {import("/study/optimisation_view.js").OptimisationView} OptimisationView */

/** @param {HTMLElement} element  @param {OptimisationView} view  @param {AbortSignal} signal */
export function candidateScatter(element, view, signal) {
  const made = makeChart(element, () => optionOf(view),
    "Candidates over two of their numbers; the table below has the same numbers", signal);
  made.then(({ chart }) => chart.on("click", ({ data }) => {
    const job = /** @type {any} */ (data)?.job;
    if (job) view.selection.toggle([job]);
  })).catch(() => {});
  return made;
}

/** @param {OptimisationView} view */
function optionOf(view) {
  const { candidates, x, y, selection } = view;
  const shown = candidates.filter((row) => typeof row[x] === "number" && typeof row[y] === "number");
  if (shown.length === 0) return nothingYet("", "No candidate has both values.");
  const dataOf = (rows) => rows.map((row) => ({ value: [row[x], row[y], row.candidate], job: row.job_id }));
  const series = (name, rows, look) => ({ type: "scatter", name, symbolSize: 8, data: dataOf(rows),
    ...look });
  const others = shown.filter((row) => !row.on_front);
  const front = shown.filter((row) => row.on_front).sort((a, b) => a[x] - b[x]);
  const chosen = shown.filter((row) => selection.has(row.job_id));
  // Between two points of the front the better value of x is that of one of them.
  const goal = view.study.objectives.find(({ metric }) => metric === x)?.goal;
  const isFront = view.metrics.length === 2 && view.metrics.includes(x) && view.metrics.includes(y);
  const axis = (column, gap) => ({ ...fittedAxis, name: titleOfMetric(column), nameLocation: "middle",
    nameGap: gap,
    ...axisLook() });
  return {
    grid: { left: 75, right: 25, top: 44, bottom: 50 }, legend: { top: 0 },
    tooltip: { formatter: ({ seriesName, value }) => [`candidate ${value[2]}, ${seriesName}`,
      `${titleOfMetric(x)}: ${number(value[0])}`, `${titleOfMetric(y)}: ${number(value[1])}`].join("\n") },
    xAxis: axis(x, 28), yAxis: axis(y, 55),
    series: [
      series("feasible", others.filter(({ state }) => state === "feasible"),
        { itemStyle: { color: colour("quiet"), opacity: 0.6 } }),
      series("infeasible", others.filter(({ state }) => state === "infeasible"),
        { symbol: "emptyTriangle", itemStyle: { color: lineColour(1) } }),
      series(view.hasFront ? "Pareto front" : "best", front,
        { symbolSize: 11, itemStyle: { color: lineColour(0) } }),
      ...(isFront ? [{ type: "line", name: "Pareto front", silent: true, symbol: "none",
        step: goal === "maximise" ? "start" : "end",
        color: lineColour(0), data: front.map((row) => [row[x], row[y]]) }] : []),
      { type: "scatter", name: "selected", silent: true, symbolSize: 17, z: 5, data: dataOf(chosen),
        itemStyle: ring },
    ].filter(({ data }) => data.length > 0),
  };
}
