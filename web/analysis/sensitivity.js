// SPDX-License-Identifier: Apache-2.0
// Sobol's indices as bars with their intervals; Morris' effects as places: size across, scatter up.
import { findAnalysis } from "/core/api.js";
import { axisLook, makeChart } from "/core/charts.js";
import { h } from "/core/dom.js";
import { nameOf, number, titleOf, unitOf } from "/core/format.js";
import { colour, lineColour } from "/core/theme.js";
import { acrossAxis, axisColumns, bars, table, valueAxis, where } from "/analysis/parts.js";

/**
 * @param {HTMLElement} element
 * @param {AnalysedSweep} analysed
 * @param {AbortSignal} signal
 */
export async function sensitivityCard(element, { sweep, metric }, signal) {
  const rows = await findAnalysis(sweep.id, "sensitivity", { metric }, signal);
  const axes = sweep.axes.filter((axis) => rows[0][axis] !== undefined);
  const morris = "effect_size" in rows[0];
  const between = (row, key) => `${number(row[key])} (${number(row[`${key}_low`])} to ${number(row[`${key}_high`])})`;
  const measures = morris ? [["µ*: mean absolute effect", (row) => between(row, "effect_size")],
    ["µ: mean effect", (row) => number(row.effect_mean)],
    ["σ: standard deviation", (row) => number(row.effect_deviation)]]
    : [["First order", (row) => between(row, "first_order")], ["Total", (row) => between(row, "total")]];
  const drawing = h("div", { class: "chart tall" });
  element.replaceChildren(drawing,
    table("Sensitivity", rows, [...axisColumns(axes), ["Parameter", (row) => titleOf(row.parameter)], ...measures,
    ["Noise between replicates",
      (row) => (row.noise === null ? "–" : `${number(100 * row.noise, 3)} % of the variance`)], ["Blocks",
      (row) => `${row.blocks}${row.blocks_missing ? `, ${row.blocks_missing} without values` : ""}`]]));
  return makeChart(drawing, () => (morris ? effects(rows, axes, metric) : indices(rows, axes)),
    "Sensitivity; the table below has the same numbers", signal);
}

const nameIn = (row, axes) => [nameOf(row.parameter), where(row, axes)].filter(Boolean).join(", ");

function indices(rows, axes) {
  const kinds = [["first_order", "first order"], ["total", "total"]];
  const shift = (index) => (index - 0.5) * 0.3;
  return {
    grid: { left: 60, right: 20, top: 40, bottom: 60 }, legend: { top: 0, data: kinds.map(([, name]) => name) },
    tooltip: { formatter: ({ value }) => number(value[1]) },
    xAxis: { type: "value", min: -1, max: rows.length, interval: 1, ...axisLook(), splitLine: { show: false },
      axisLabel: { color: colour("text"),
        formatter: (at) => (Number.isInteger(at) && rows[at] ? nameIn(rows[at], axes) : "") } },
    yAxis: valueAxis("Sobol index: share of the variance", { min: 0, scale: false }),
    series: kinds.flatMap(([key, name], index) =>
      [{ name, type: "scatter", color: lineColour(index), symbol: index === 0 ? "circle" : "diamond", symbolSize: 12,
        data: rows.map((row, at) => [at + shift(index), row[key]]) },
      bars(lineColour(index), rows.map((row, at) => [at + shift(index), row[`${key}_low`], row[`${key}_high`]]), 3)]),
  };
}

function effects(rows, axes, metric) {
  const unit = unitOf(metric);
  return {
    grid: { left: 75, right: 120, top: 20, bottom: 50 },
    tooltip: { formatter: ({ dataIndex }) => nameIn(rows[dataIndex], axes) },
    xAxis: acrossAxis(`µ*: mean absolute effect [${unit || "1"}]`, { min: 0, scale: false }),
    yAxis: valueAxis(`σ: standard deviation of the effect [${unit || "1"}]`, { min: 0, scale: false }),
    series: [{ type: "scatter", color: lineColour(0), symbolSize: 12,
      data: rows.map((row) => [row.effect_size, row.effect_deviation]),
      label: { show: true, position: "right", color: colour("text"),
        formatter: ({ dataIndex }) => nameIn(rows[dataIndex], axes) } }],
  };
}
