// SPDX-License-Identifier: Apache-2.0
// A metric over one axis, a line for each value of a second one (and of the panels' axis), with the spread of what
// lies together.
import { axisLook, makeChart, nothingYet } from "/core/charts.js";
import { nameOf, number, plural, pointOf, titleOf, unitOf } from "/core/format.js";
import { colour, lineColour } from "/core/theme.js";
import { averagedAxes, groupBy, none, valuesOf } from "/study/data.js";
import { legendOf } from "/study/legend.js";
import { chosenLogs } from "/study/log_axes.js";
import { whyEmpty, withoutValue } from "/study/missing.js";
import { fittedAxis } from "/study/span.js";

const mostLines = 30;
const fewPoints = 400;  // whose marks do not hide the lines
const widthOfLetter = 6.3;  // of the notes, in pixels: about
const symbols = ["circle", "rect", "triangle", "diamond", "roundRect", "arrow"];

/** @param {HTMLElement} element  @param {SweepPage} sweep  @param {AbortSignal} signal */
export function linesChart(element, sweep, signal) {
  /** @type {Group[][]} */
  let groups = [];
  const made = makeChart(element, () => {
    const plan = planOf(sweep, element.clientWidth);
    groups = plan.groups;
    return plan.option;
  }, "Lines of the metric over one axis; the table below has the same numbers", signal);
  made.then(({ chart }) => chart.on("click", ({ seriesId, dataIndex }) => {
    const group = groups[Number(seriesId?.split(":")[1])]?.[dataIndex];
    if (group) sweep.selection.toggle(group.jobs);
  })).catch(() => {});
  return made;
}

/** @param {SweepPage} sweep  @param {number} width */
function planOf(sweep, width) {
  const { rows, view, selection, others } = sweep;
  const xs = valuesOf([...rows, ...(others?.rows ?? [])], view.x);
  const numeric = xs.every((x) => typeof x === "number");
  const [own, theirs] = [linesOf(rows, view, ""), others ? linesOf(others.rows, view, others.name) : []];
  const all = [...own, ...theirs];
  const lines = all.slice(0, mostLines);
  const few = lines.reduce((sum, line) => sum + line.groups.length, 0) <= fewPoints;
  const at = (value) => (numeric ? value : xs.indexOf(value));
  const logs = chosenLogs(sweep);
  const x = numeric ? { type: logs.x ? "log" : "value", scale: true }
    : { type: "category", data: xs.map((value) => number(value, 4)) };
  const groups = lines.map((line) => line.groups);
  if (lines.length === 0) return { groups, option: nothingYet(whyEmpty(sweep)) };
  const notes = notesOf(sweep, own, theirs);
  const noteLines = notes.reduce((sum, note) => sum + Math.ceil((note.length * widthOfLetter) / width), 0);
  const legend = legendOf(lines.map(({ name }) => name), width);
  return { groups, option: {
    grid: { left: 75, right: 20, top: 16 + legend.height, bottom: 50 + 18 * noteLines },
    legend: legend.option,
    // A screen reader is told a chart's title, also where it is not shown: without a note there must be none.
    title: { show: notes.length > 0, text: notes.join("\n"), bottom: 0, left: 0,
      textStyle: { width, overflow: "break", fontSize: 12, lineHeight: 18, fontWeight: "normal",
        color: colour("text") } },
    tooltip: { formatter: ({ seriesId, dataIndex }) => textOf(lines[Number(seriesId.split(":")[1])], dataIndex, view) },
    xAxis: { ...x, name: titleOf(view.x), nameLocation: "middle", nameGap: 28, ...(logs.x ? logLook() : axisLook()) },
    yAxis: { name: titleOf(view.metric), nameLocation: "middle", nameGap: 50,
      ...(logs.metric ? { type: "log", ...logLook() } : { ...fittedAxis, ...axisLook() }) },
    series: lines.flatMap((line, index) =>
      [...(line.groups.some((group) => group.count > 1) ? [spreadSeries(line, index, at)] : []),
        lineSeries(line, index, at, few),
      ...chosenSeries(line, index, at, selection)]),
  } };
}

/// Decades as 1e−6, not as 0.000001.
function logLook() {
  const look = axisLook();
  return { ...look, axisLabel: { ...look.axisLabel, formatter: (value) => number(value) } };
}

/// Notes below the lines: averages, missing values, lines left out.
/** @param {SweepPage} sweep */
function notesOf(sweep, own, theirs) {
  const averagedIn = (lines, drawn) => averagedAxes(lines.flatMap((line) => line.groups), drawn);
  const averaged = new Set([...averagedIn(own, sweep), ...averagedIn(theirs, { ...sweep.others, view: sweep.view })]);
  const count = own.length + theirs.length;
  const without = withoutValue(sweep).length;
  return [averaged.size > 0
    && `Mean over ${[...averaged].map((axis) => nameOf(axis).toLowerCase()).join(", ")}; bars: range.`,
    without > 0 && `${plural(without, "computed job")} without a value: the table says why.`,
    count > mostLines && `The first ${mostLines} of ${count} series: choose fewer values, or another axis.`].filter(
      Boolean);
}

/// Lines with a value at least; where jobs have none, a group without a mean stands in its place.
/// @param name  of the sweep, where it is not the one that is looked at
/** @param {Api.Row[]} rows  @param {SweepPage["view"]} view  @param {string} name */
function linesOf(rows, view, name) {
  const keys = [view.y, view.panel].filter(Boolean);
  /** @type {Map<string, Group[]>} */
  const byLine = new Map();
  for (const group of groupBy(rows, [...keys, view.x], view.metric)) {
    const key = JSON.stringify(group.values.slice(0, -1));
    const line = byLine.get(key) ?? [];
    byLine.set(key, line);
    line.push(group);
  }
  const nameOfLine = ({ values }) => [...keys.map((key, i) => (values[i] === none ? "" : pointOf(key, values[i]))),
    name].filter(Boolean).join(", ") || nameOf(view.metric);
  const order = new Map(valuesOf(rows, view.x).map((value, place) => [value, place]));
  const x = (group) => order.get(group.values.at(-1));
  const drawn = [...byLine.values()].filter((groups) => groups.some(hasValue));
  return drawn.map((groups) =>
    ({ name: nameOfLine(groups[0]), dashed: name !== "", groups: groups.sort((a, b) => x(a) - x(b)) }));
}

const hasValue = (group) => group?.count > 0;

/// Line with gaps where values are missing. A value between two gaps is marked even among many points, for it has
/// no line.
function lineSeries({ name, dashed, groups }, index, at, few) {
  const symbol = symbols[index % symbols.length];
  const isAlone = (place) => !hasValue(groups[place - 1]) && !hasValue(groups[place + 1]);
  const dataOf = (group, place) => {
    const value = [at(group.values.at(-1)), group.mean ?? "-"];
    return !few && isAlone(place) ? { value, symbol } : value;
  };
  return { id: `line:${index}`, name, type: "line", symbol: few ? symbol : "none", showAllSymbol: true, symbolSize: 8,
    color: lineColour(index),
    lineStyle: { type: dashed ? "dashed" : "solid" }, data: groups.map(dataOf) };
}

/// Rings around what is selected; nothing, where nothing is.
function chosenSeries(line, index, at, selection) {
  const chosen = selection.size === 0 ? []
    : line.groups.filter((group) => hasValue(group) && group.jobs.some((job) => selection.has(job)));
  if (chosen.length === 0) return [];
  return [{ id: `chosen:${index}`, name: line.name, type: "scatter", silent: true, symbol: "circle", symbolSize: 15,
    z: 5,
    itemStyle: { color: "transparent", borderColor: "#e6007a", borderWidth: 3 },
    data: chosen.map((group) => [at(group.values.at(-1)), group.mean]) }];
}

function textOf({ name, groups }, index, view) {
  const group = groups[index];
  const several = group.count > 1 ? `\nmean of ${group.count}: ${number(group.min)} to ${number(group.max)}` : "";
  return [name, `${nameOf(view.x)} ${pointOf(view.x, group.values.at(-1))}`,
    `${number(group.mean)} ${unitOf(view.metric)}${several}`].join("\n");
}

/// From the least to the largest of what lies together, as an upright bar.
function spreadSeries(line, index, at) {
  return { id: `spread:${index}`, name: line.name, type: "custom", silent: true, color: lineColour(index),
    data: line.groups.filter((group) => group.count > 1)
      .map((group) => [at(group.values.at(-1)), group.min, group.max]),
    encode: { x: 0, y: [1, 2] },
    renderItem: (_, api) => {
      const [x, low] = api.coord([api.value(0), api.value(1)]);
      const [, high] = api.coord([api.value(0), api.value(2)]);
      const style = { stroke: api.visual("color"), lineWidth: 2, opacity: 0.6 };
      const stroke = (x1, y1, x2, y2) => ({ type: "line", shape: { x1, y1, x2, y2 }, style });
      return { type: "group",
        children: [stroke(x, low, x, high), stroke(x - 5, low, x + 5, low), stroke(x - 5, high, x + 5, high)] };
    } };
}
