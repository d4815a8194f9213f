// SPDX-License-Identifier: Apache-2.0
// An objective over the candidates of an optimisation, with the best feasible value so far.
import { axisLook, makeChart, nothingYet, numberLook } from "/core/charts.js";
import { number, titleOf } from "/core/format.js";
import { colour, lineColour } from "/core/theme.js";
import { spansDecades } from "/study/span.js";

/**
 * @param {HTMLElement} element
 * @param {import("/study/optimisation_view.js").OptimisationView} view
 * @param {AbortSignal} signal
 */
export function bestSoFarChart(element, view, signal) {
  return makeChart(element, () => optionOf(view),
    "Objective over the candidates; the table below has the same numbers", signal);
}

/** @param {import("/study/optimisation_view.js").OptimisationView} view */
function optionOf({ candidates, objective, study }) {
  const computed = candidates.filter((row) => typeof row[objective] === "number");
  if (computed.length === 0) return nothingYet("", "No candidate has a value.");
  const isMost = study.objectives.find(({ metric }) => metric === objective)?.goal === "maximise";
  /** @type {number[][]} */
  const best = [];
  for (const row of computed) {
    const last = best.at(-1)?.[1];
    const better = last === undefined || (isMost ? row[objective] > last : row[objective] < last);
    if (row.state !== "feasible" && last === undefined) continue;
    best.push([row.candidate, row.state === "feasible" && better ? row[objective] : Number(last)]);
  }
  const isLog = spansDecades(computed.map((row) => row[objective]));
  const marks = (state, index, opacity) => ({ type: "scatter", name: state, symbolSize: 6,
    itemStyle: { color: index < 0 ? colour("quiet") : lineColour(index), opacity },
    data: computed.filter((row) => row.state === state).map((row) => [row.candidate, row[objective]]) });
  return {
    grid: { left: 75, right: 20, top: 44, bottom: 50 }, legend: { top: 0 },
    tooltip: { formatter: ({ seriesName, value }) =>
      `${seriesName}\ncandidate ${value[0]}: ${number(value[1])}` },
    xAxis: { type: "value", name: "candidate", nameLocation: "middle", nameGap: 28, minInterval: 1,
      ...axisLook() },
    yAxis: { type: isLog ? "log" : "value", scale: true, name: titleOf(objective), nameLocation: "middle",
      nameGap: 55, ...numberLook() },
    series: [marks("feasible", -1, 0.6), ...(computed.some(({ state }) => state === "infeasible")
      ? [marks("infeasible", 1, 0.6)] : []),
    { type: "line", step: "end", symbol: "none", name: "best so far", color: lineColour(0), data: best }],
  };
}
