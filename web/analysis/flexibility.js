// SPDX-License-Identifier: Apache-2.0
// Rigid and flexible jobs side by side.
import { findAnalysis } from "/core/api.js";
import { makeChart } from "/core/charts.js";
import { h } from "/core/dom.js";
import { nameOf, number, pointOf, titleOf } from "/core/format.js";
import { colour, lineColour } from "/core/theme.js";
import { acrossAxis, axisColumns, bars, table, valueAxis, where } from "/analysis/parts.js";

/// Whether an axis makes a link rigid or flexible.
/** @param {string} axis */
export const isOfLink = (axis) => axis === "coupler" || /^linkage\.bodies\..*\.beam\.elements$/.test(axis);

const percent = (part) => (part === null ? "–" : `${number(100 * part, 3)} %`);

/**
 * @param {HTMLElement} element
 * @param {AnalysedSweep} analysed
 * @param {AbortSignal} signal
 */
export async function flexibilityCard(element, { sweep, metric }, signal) {
  const rows = await findAnalysis(sweep.id, "flexibility", { metric }, signal);
  const axes = sweep.axes.filter((axis) => axis in rows[0]);
  const along = rows[0]?.along;
  const drawing = h("div", { class: "chart tall", hidden: !along });
  const reversed = rows.filter((row) => row.reverses_from !== null);
  const single = rows.filter(isSingle).length;
  const said = single === rows.length ? "" : reversed.length === 0
    ? "No reversal: the ratio does not cross 1 by more than 0.1 %, the accuracy of peaks."
    : `Reversal: ${reversed.map((row) => reversalOf(row, axes)).join("; ")}.`;
  element.replaceChildren(h("p", {}, along ? said : ""), single > 0
    ? h("p", { role: "note" }, singleText(single, rows.length)) : "",
    drawing,
    table("Rigid and flexible", rows, [...axisColumns(axes), ["Flexible / rigid", (row) => number(row.ratio)],
    ["Range", (row) => (isSingle(row) ? "–" : `${number(row.ratio_least)} to ${number(row.ratio_largest)}`)],
    ["Verdict", verdictOf],
    ["Structural loss [J]", (row) => number(row.coupler_loss_j)],
    ["Share of all losses", (row) => percent(row.coupler_loss_part)]]));
  return along ? makeChart(drawing, () => optionOf(rows, axes, along, metric),
    "Ratio of flexible to rigid; the table below has the same numbers", signal) : null;
}

/** @typedef {Api.Get<"/v1/sweeps/{id}/flexibility">[number]} Pair */

/// True of a pair without replicates: how far its values scatter is not known.
/** @param {Pair} row */
const isSingle = ({ verdict }) => verdict === "one_run_each";

/** @param {number} single  @param {number} all */
function singleText(single, all) {
  const which = single === all ? "Each ratio comes"
    : `${single.toLocaleString("en")} of ${all.toLocaleString("en")} ratios come`;
  return `${which} from one run each, which may scatter by more than they differ: replicates give a verdict.`;
}

/// Verdict on a pair: with replicates only.
/** @param {Pair} row */
function verdictOf(row) {
  if (row.ratio === null) return "–";
  if (isSingle(row)) return "one run each";
  return row.verdict === "either" && Number(row.ratio_least) >= 0.999 && Number(row.ratio_largest) <= 1.001
    ? "no difference" : row.verdict ?? "–";
}

/// Between which two values of a parameter the ratio passes 1.
/** @param {Api.Get<"/v1/sweeps/{id}/flexibility">[number]} row  @param {string[]} axes */
function reversalOf({ along, reverses_from: from, ...row }, axes) {
  if (typeof along !== "string" || typeof from !== "number") return "";
  return `between ${pointOf(along, from)} and ${where(row, [along, ...axes.filter((axis) => axis !== along)])}`;
}

function optionOf(rows, axes, along, metric) {
  const drawn = rows.filter((row) => row.ratio !== null).sort((a, b) => a[along] - b[along]);
  if (drawn.length === 0) return null;
  const others = axes.filter((axis) => axis !== along);
  const lines = groupBy(drawn, (row) => where(row, others));
  return {
    grid: { left: 75, right: 20, top: 40, bottom: 50 },
    legend: { top: 0, show: others.length > 0, data: [...lines.keys()] },
    tooltip: { formatter: ({ value }) => `${pointOf(along, value[0])}\n${number(value[1])}` },
    xAxis: acrossAxis(titleOf(along)), yAxis: valueAxis(`${nameOf(metric)}, flexible / rigid`),
    series: [...lines].flatMap(([name, line], index) =>
      [bars(lineColour(index), line.filter((row) => !isSingle(row)).map((row) => [row[along],
        row.ratio_least, row.ratio_largest])),
      { name, type: "line", color: lineColour(index), symbolSize: 8, data: line.map((row) => [row[along], row.ratio]),
        ...(index === 0 ? { markLine: { symbol: "none", silent: true, label: { show: false },
          lineStyle: { color: colour("quiet") }, data: [{ yAxis: 1 }] } } : {}) }]),
  };
}

function groupBy(rows, keyOf) {
  const groups = new Map();
  for (const row of rows) groups.set(keyOf(row), [...(groups.get(keyOf(row)) ?? []), row]);
  return groups;
}
