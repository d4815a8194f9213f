// SPDX-License-Identifier: Apache-2.0
// A surrogate as a surface of colours (or a line over a single number), never without the points that it stands on.
import { findAnalysis } from "/core/api.js";
import { makeChart } from "/core/charts.js";
import { choice, h } from "/core/dom.js";
import { nameOf, number, pointOf, titleOf, unitOf } from "/core/format.js";
import { latest, retryWhileUnreachable } from "/core/live.js";
import { colour, lineColour, palette } from "/core/theme.js";
import { acrossAxis, valueAxis } from "/analysis/parts.js";

/** @typedef {Api.Get<"/v1/sweeps/{id}/surrogate">} Surrogate */
/** @typedef {Surrogate["surfaces"][number]} Surface */

/**
 * @param {HTMLElement} element
 * @param {AnalysedSweep} analysed
 * @param {AbortSignal} signal
 */
export async function surrogateCard(element, { sweep, metric }, signal) {
  let made = await findAnalysis(sweep.id, "surrogate", { metric }, signal);
  let shown = 0;
  const drawing = h("div", { class: "chart tall" });
  const said = h("p", { role: "status" });
  const pickers = h("p", { class: "actions" });
  let chart = null;
  const load = latest(async (current, /** @type {string} */ x, /** @type {string | undefined} */ y) => {
    made = await findAnalysis(sweep.id, "surrogate", { metric, x, y }, current);
    draw();
  }, signal);
  const tell = (text) => { if (text) said.textContent = text; };
  const again = (x, y) => retryWhileUnreachable(() => load(x, y), tell, signal).catch((error) => tell(error.message));
  const draw = () => {
    drawing.hidden = made.surfaces[shown].values === null;
    said.textContent = judgement(made.surfaces[shown], made);
    const names = made.inputs.map(({ parameter }) => [parameter, titleOf(parameter)]);
    const groups = made.surfaces.map(({ where }, index) =>
      [String(index), Object.entries(where).map(([axis, value]) => pointOf(axis, value)).join(", ")]);
    const other = (than) => made.inputs.find(({ parameter }) => parameter !== than)?.parameter;
    pickers.replaceChildren(
      ...[groups.length > 1 && choice("Group", groups, String(shown), (index) => { shown = Number(index); draw(); }),
      names.length > 1 && choice("x axis", names, made.x,
        (x) => again(x, x === made.y ? other(x) : made.y ?? undefined)),
      names.length > 2 && made.y !== null && choice("y axis", names.filter(([name]) => name !== made.x), made.y,
        (y) => again(made.x, y))].filter(Boolean));
    chart?.draw();
  };
  element.replaceChildren(pickers, said, drawing);
  draw();
  chart = await makeChart(drawing, () => optionOf(made, made.surfaces[shown]),
    "Surrogate, with the jobs that it is fitted to", signal);
  return chart;
}

/** @param {Surface} surface  @param {Surrogate} surrogate */
function judgement(surface, { metric, x, y, inputs }) {
  if (surface.degree === null) return `No surrogate: it needs 6 points or more, and there are ${surface.points}.`;
  const others = inputs.filter(({ parameter }) => parameter !== x && parameter !== y)
    .map(({ parameter, middle }) => `${nameOf(parameter)} ${number(middle)} ${unitOf(parameter)}`);
  const at = others.length > 0 ? `; drawn at ${others.join(", ")}, with the points of all values` : "";
  const part = surface.predicted_part !== null && surface.predicted_part > 0
    ? `${number(100 * surface.predicted_part, 3)} % of the variance explained`
    : "no better than the mean, so of no use here";
  return `Degree ${surface.degree}, ${surface.terms} terms, ${surface.points} points; `
    + `leave-one-out error ${[number(surface.cross_validation_error), unitOf(metric)].join(" ").trim()}, `
    + `${part}${at}.`;
}

/** @param {Surrogate} made  @param {Surface} surface */
function optionOf(made, surface) {
  if (surface.values === null) return null;
  return made.y ? surfaceOption(made, surface) : lineOption(made, surface);
}

function lineOption({ metric, x }, { x_values: xs, values, at }) {
  return {
    grid: { left: 75, right: 20, top: 40, bottom: 50 },
    tooltip: { formatter: ({ value }) => `${number(value[0])}: ${number(value[1])}` },
    xAxis: acrossAxis(titleOf(x)), yAxis: valueAxis(titleOf(metric)),
    series: [{ name: "surrogate", type: "line", color: lineColour(0), showSymbol: false,
      data: xs.map((value, i) => [value, values[0][i]]) },
      { name: "jobs", type: "scatter", color: lineColour(1), symbolSize: 9,
        data: at.map((point) => [point[x], point.value]) }],
  };
}

/// Cells of colour, and the points in the colours of their own values.
function surfaceOption({ metric, x, y }, { x_values: xs, y_values: ys, values, at }) {
  const cells = ys.flatMap((up, j) => xs.map((across, i) => [across, up, values[j][i]]));
  const points = at.map((point) => [point[x], point[y], point.value]);
  const all = [...cells, ...points].map(([, , value]) => value);
  const edge = (list, i) => [(list[i] + list[Math.max(i - 1, 0)]) / 2,
    (list[i] + list[Math.min(i + 1, list.length - 1)]) / 2];
  return {
    grid: { left: 75, right: 20, top: 20, bottom: 125 },
    title: { text: titleOf(metric), left: "center", bottom: 58,
      textStyle: { fontSize: 12, fontWeight: "normal", color: colour("text") } },
    tooltip: { formatter: ({ value }) => [`${titleOf(x)} ${number(value[0])}`, `${titleOf(y)} ${number(value[1])}`,
      `${nameOf(metric)} ${number(value[2])} ${unitOf(metric)}`].join("\n") },
    xAxis: acrossAxis(titleOf(x)), yAxis: valueAxis(titleOf(y)),
    visualMap: { min: Math.min(...all), max: Math.max(...all), dimension: 2, calculable: true, orient: "horizontal",
      left: "center", bottom: 0, precision: 3, inRange: { color: palette() },
      textStyle: { color: colour("text") }, formatter: (value) => number(value, 3) },
    series: [{ name: "surrogate", type: "custom", data: cells, encode: { x: 0, y: 1 },
      renderItem: ({ dataIndex }, api) => {
      const [left, right] = edge(xs, dataIndex % xs.length);
      const [low, high] = edge(ys, Math.floor(dataIndex / xs.length));
      const [x1, y1] = api.coord([left, high]);
      const [x2, y2] = api.coord([right, low]);
      return { type: "rect", shape: { x: x1, y: y1, width: x2 - x1 + 0.5, height: y2 - y1 + 0.5 },
        style: { fill: api.visual("color") } };
    } },
    { name: "jobs", type: "scatter", symbolSize: 11, itemStyle: { borderColor: colour("text"), borderWidth: 1.5 },
      data: points }],
  };
}
