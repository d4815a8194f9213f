// SPDX-License-Identifier: Apache-2.0
// A metric over one axis, a curve for each value of a second one (and of the panels' axis), with the spread
// of what lies together. Numbers are told apart by a colour scale, words by line style.
import { axisLook, makeChart, nothingYet, numberLook } from "/core/charts.js";
import { nameOf, number, plural, pointOf, titleOf, unitOf } from "/core/format.js";
import { colour, ring } from "/core/theme.js";
import { colourBar, colourBarHeight } from "/study/colour_bar.js";
import { curvesOf, drawnCurves, looksOf, mostCurves, nameOfCurve, rolesOf } from "/study/curves.js";
import { averagedAxes, onceFor, valuesOf } from "/study/data.js";
import { legendOf } from "/study/legend.js";
import { chosenLogs } from "/study/log_axes.js";
import { whyEmpty, withoutValue } from "/study/missing.js";
import { fittedAxis } from "/study/span.js";

const fewPoints = 400;  // so many marks do not hide the lines
const widthOfLetter = 6.3;  // of the notes, in pixels: about
const left = 75;

/** @typedef {import("/study/curves.js").Curve & { name: string, label: string, colour: string, pattern: string | number[], symbol: string }} DrawnCurve */

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

/// Curves of the sweep and of the one beside it: all of them, and those that are drawn.
/** @param {SweepPage} sweep */
export function curvesOfSweep(sweep) {
  const { rows, view, others } = sweep;
  const asked = [view.metric, view.x, view.y, view.panel, view.curves, others?.id];
  return onceFor(rows, `curves of ${JSON.stringify(asked)}`, () => findCurves(sweep));
}

/** @param {SweepPage} sweep */
function findCurves(sweep) {
  const { rows, view, others } = sweep;
  const roles = rolesOf(sweep);
  const own = curvesOf(rows, view, roles);
  const theirs = others ? curvesOf(others.rows, view, roles, others.name) : [];
  const most = others ? mostCurves / 2 : mostCurves;
  const drawn = drawnCurves(own, view.curves, most);
  const alike = theirs.filter(({ key }) => drawn.some((curve) => curve.key === key)).map(({ key }) => key);
  return { roles, own, theirs, most, drawn, drawnTheirs: drawnCurves(theirs, alike, most) };
}

/** @param {SweepPage} sweep  @param {number} width */
function planOf(sweep, width) {
  const { rows, view, selection, others } = sweep;
  const { roles, own, theirs, drawn, drawnTheirs } = curvesOfSweep(sweep);
  const lines = dressed([...drawn, ...drawnTheirs], sweep, roles);
  const groups = lines.map((line) => line.groups);
  if (lines.length === 0) return { groups, option: nothingYet(whyEmpty(sweep)) };
  const xs = valuesOf([...rows, ...(others?.rows ?? [])], view.x);
  const numeric = xs.every((x) => typeof x === "number");
  const few = lines.reduce((sum, line) => sum + line.groups.length, 0) <= fewPoints;
  const at = (value) => (numeric ? value : xs.indexOf(value));
  const logs = chosenLogs(sweep);
  const x = numeric ? { type: logs.x ? "log" : "value", scale: true }
    : { type: "category", data: xs.map((value) => number(value, 4)) };
  const notes = notesOf(sweep, [...own, ...theirs], lines);
  const noteLines = notes.reduce((sum, note) => sum + Math.ceil((note.length * widthOfLetter) / width), 0);
  const key = keyAbove(sweep, roles, lines, width);
  return { groups, option: {
    aria: { enabled: true, label: { description: spoken(sweep, lines, [...own, ...theirs].length) } },
    grid: { left, right: 20, top: 16 + key.height, bottom: 50 + 18 * noteLines },
    legend: key.legend, graphic: key.graphic,
    // A screen reader is told a chart's title, also where it is not shown: without a note there must be none.
    title: { show: notes.length > 0, text: notes.join("\n"), bottom: 0, left: 0,
      textStyle: { width, overflow: "break", fontSize: 12, lineHeight: 18, fontWeight: "normal",
        color: colour("text") } },
    tooltip: { formatter: ({ seriesId, dataIndex }) => textOf(lines[Number(seriesId.split(":")[1])], dataIndex, view) },
    xAxis: { ...x, name: titleOf(view.x), nameLocation: "middle", nameGap: 28,
      ...(logs.x ? numberLook() : axisLook()) },
    yAxis: { name: titleOf(view.metric), nameLocation: "middle", nameGap: 50,
      ...(logs.metric ? { type: "log", ...numberLook() } : { ...fittedAxis, ...axisLook() }) },
    series: lines.flatMap((line, index) =>
      // The legend shows the first one of a name: the line.
      [lineSeries(line, index, at, few),
        ...(line.groups.some((group) => group.count > 1) ? [spreadSeries(line, index, at)] : []),
        ...chosenSeries(line, index, at, selection)]),
  } };
}

/// Curves with their looks and two names: that of the curve, and that of its entry in the legend.
/**
 * @param {import("/study/curves.js").Curve[]} curves
 * @param {SweepPage} sweep
 * @param {ReturnType<typeof rolesOf>} roles
 */
function dressed(curves, { rows, view, others }, roles) {
  const lookOf = looksOf([...rows, ...(others?.rows ?? [])], roles);
  const inLegend = (curve) => (roles.isScale
    ? nameOfCurve({ ...curve, values: curve.values.slice(1) }, { ...roles, colour: roles.style, style: "" })
      : nameOfCurve(curve, roles));
  return curves.map((curve) => ({ ...curve, ...lookOf(curve), name: nameOfCurve(curve, roles)
    || nameOf(view.metric),
    label: inLegend(curve) || nameOf(view.metric) }));
}

/// Key of the curves: a colour bar for numbers, a legend for the rest.
/**
 * @param {SweepPage} sweep
 * @param {ReturnType<typeof rolesOf>} roles
 * @param {DrawnCurve[]} lines
 * @param {number} width
 */
function keyAbove({ rows, others }, roles, lines, width) {
  const names = [...new Set(lines.map(({ label }) => label))];
  const barHeight = roles.isScale ? colourBarHeight : 0;
  const legend = legendOf(names, width);
  const hasLegend = !roles.isScale || names.length > 1;
  const numbers = (values) => values.filter((value) => typeof value === "number");
  return { height: barHeight + (hasLegend ? legend.height : 0),
    legend: { ...legend.option, show: hasLegend, top: barHeight, ...(roles.isScale ? { itemWidth: 40 } : {}),
      data: names.map((name) => entryOf(name, roles, lines)) },
    graphic: roles.isScale ? colourBar(roles.colour, numbers(valuesOf([...rows, ...(others?.rows ?? [])],
      roles.colour)),
      numbers(lines.map(({ values }) => values[0])), width, left) : [] };
}

/// Entry of the legend: in the colour of the text where colours stand for numbers.
function entryOf(name, { isScale }, lines) {
  if (!isScale) return { name };
  const { pattern } = lines.find(({ label }) => label === name);
  return { name, itemStyle: { color: colour("text") }, lineStyle: { color: colour("text"), type: pattern,
    width: 2 } };
}

/// The chart in words.
function spoken({ view }, lines, count) {
  return `${nameOf(view.metric)} over ${nameOf(view.x).toLowerCase()}: ${lines.length} of ${plural(count, "curve")}: `
    + `${lines.map(({ name }) => name).join("; ")}.`;
}

/// Notes below the lines: averages, missing values, curves left out.
/** @param {SweepPage} sweep  @param {import("/study/curves.js").Curve[]} all  @param {DrawnCurve[]} drawn */
function notesOf(sweep, all, drawn) {
  const averagedIn = (curves, rows) => averagedAxes(curves.flatMap((curve) => curve.groups), rows);
  const [own, theirs] = [all.filter((curve) => !curve.sweep), all.filter((curve) => curve.sweep)];
  const averaged = new Set([...averagedIn(own, sweep), ...averagedIn(theirs, { ...sweep.others, view: sweep.view })]);
  const without = withoutValue(sweep).length;
  const which = sweep.view.curves ? "as chosen" : "evenly spread, with the one of the largest value";
  return [averaged.size > 0
    && `Mean over ${[...averaged].map((axis) => nameOf(axis).toLowerCase()).join(", ")}; bars: range.`,
    without > 0 && `${plural(without, "computed job")} without a value: the table says why.`,
    all.length > drawn.length && `${drawn.length} of ${all.length} curves, ${which}.`].filter(Boolean);
}

const hasValue = (group) => group?.count > 0;

/// Line with gaps where values are missing. A value between two gaps is marked even among many points, for it has
/// no line.
/** @param {DrawnCurve} curve  @param {number} index  @param {(value: any) => any} at  @param {boolean} few */
function lineSeries({ label, sweep, groups, colour: color, pattern, symbol: mark }, index, at, few) {
  const symbol = sweep ? `empty${mark[0].toUpperCase()}${mark.slice(1)}` : mark;
  const isAlone = (place) => !hasValue(groups[place - 1]) && !hasValue(groups[place + 1]);
  const dataOf = (group, place) => {
    const value = [at(group.values.at(-1)), group.mean ?? "-"];
    return !few && isAlone(place) ? { value, symbol } : value;
  };
  return { id: `line:${index}`, name: label, type: "line", symbol: few ? symbol : "none", showAllSymbol: true,
    symbolSize: 6, color, emphasis: { focus: "series" },
    lineStyle: { type: pattern, width: sweep ? 1 : 2 }, data: groups.map(dataOf) };
}

/// Rings around what is selected; nothing, where nothing is.
function chosenSeries(line, index, at, selection) {
  const chosen = selection.size === 0 ? []
    : line.groups.filter((group) => hasValue(group) && group.jobs.some((job) => selection.has(job)));
  if (chosen.length === 0) return [];
  return [{ id: `chosen:${index}`, name: line.label, type: "scatter", silent: true, symbol: "circle",
    symbolSize: 15,
    z: 5,
    itemStyle: ring,
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
  return { id: `spread:${index}`, name: line.label, type: "custom", silent: true, color: line.colour,
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
