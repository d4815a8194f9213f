// SPDX-License-Identifier: Apache-2.0
// A metric over two axes, one panel for each value of a third.
import { axisLook, makeChart, nothingYet } from "/core/charts.js";
import { nameOf, number, pointOf, titleOf, unitOf } from "/core/format.js";
import { colour, frame, palette } from "/core/theme.js";
import { averagedAxes, groupBy, valuesOf } from "/study/data.js";
import { whyEmpty } from "/study/missing.js";
import { extremesOf, widened } from "/study/span.js";

const mostPanels = 12;
const fewCells = 400;  // with lines between them
const widthOfLetter = 7;
const heightOfLabel = 20;
// Pixels: of the least height of a panel, its title, and what stands below all panels.
const [leastPanel, titleHeight, below] = [120, 24, 150];
const usualHeight = 416;

/** @param {HTMLElement} element  @param {SweepPage} sweep  @param {AbortSignal} signal */
export function heatMap(element, sweep, signal) {
  /** @type {Group[][]} */
  let cells = [];
  const made = makeChart(element, () => {
    const plan = planOf(sweep, element.clientWidth);
    element.style.height = `${plan.height ?? usualHeight}px`;
    cells = plan.cells;
    return plan.option;
  }, "Heat map of the metric over two axes; the table below has the same numbers", signal);
  made.then(({ chart }) => chart.on("click", ({ seriesIndex, dataIndex }) => {
    const cell = cells[seriesIndex]?.[dataIndex];
    if (cell) sweep.selection.toggle(cell.jobs);
  })).catch(() => {});
  return made;
}

/** @param {SweepPage} sweep  @param {number} width */
function planOf(sweep, width) {
  const { rows, view, selection } = sweep;
  const xs = valuesOf(rows, view.x);
  const ys = view.y ? valuesOf(rows, view.y) : [""];
  const allPanels = view.panel ? valuesOf(rows, view.panel) : [""];
  const panels = allPanels.slice(0, mostPanels);
  const groups = groupBy(rows, [view.x, view.y, view.panel].filter(Boolean), view.metric)
    .filter((group) => group.mean !== null);
  const isChosen = (group) => group.jobs.some((job) => selection.has(job));
  // Selected cells last: drawn before their neighbours, their frames would be covered.
  const cells = panels.map((panel) => groups.filter((group) => !view.panel || group.values.at(-1) === panel))
    .map((ofPanel) => [...ofPanel.filter((group) => !isChosen(group)), ...ofPanel.filter(isChosen)]);
  const [placeOfX, placeOfY] = [places(xs), places(ys)];
  const ends = extremesOf(groups.map((group) => group.mean).filter((mean) => mean !== null));
  if (groups.length === 0) return { cells, option: nothingYet(whyEmpty(sweep)) };
  const columns = Math.min(panels.length, width < 480 ? 2 : 3);
  const lines = Math.ceil(panels.length / columns);
  const height = Math.max(usualHeight, below + lines * (leastPanel + titleHeight));
  const { title, ...grids } = gridsOf(view, xs, ys, panels, { columns, lines, width, height });
  return { cells, height, option: {
    ...grids,
    title: [metricTitle(sweep, groups, omittedText(view, panels, allPanels)), ...title],
    tooltip: { formatter: ({ seriesIndex, dataIndex }) => textOf(cells[seriesIndex][dataIndex], view) },
    visualMap: { ...(widened(ends) ?? ends), calculable: true, orient: "horizontal", left: "center", bottom: 0,
      precision: 3,
      inRange: { color: palette() }, textStyle: { color: colour("text") }, formatter: (value) => number(value, 3),
      dimension: 2 },
    series: cells.map((groupsOfPanel, index) => ({ type: "heatmap", xAxisIndex: index, yAxisIndex: index,
      itemStyle: { borderColor: colour("card"), borderWidth: groupsOfPanel.length <= fewCells ? 1 : 0 },
      label: { show: xs.length * panels.length <= 14, formatter: ({ value }) => number(value[2], 3) },
      data: groupsOfPanel.map((group) => cellOf(group, view, placeOfX, placeOfY, selection)) })),
  } };
}

/// Count of the values with a panel; empty if all have one.
/** @param {SweepPage["view"]} view  @param {any[]} panels  @param {any[]} all */
const omittedText = (view, panels, all) => (panels.length === all.length ? ""
  : `${panels.length} of ${all.length} values of ${nameOf(view.panel).toLowerCase()}`);

/// Title of the colour scale, also in saved pictures. @param omitted  values without a panel
/** @param {SweepPage} sweep  @param {Group[]} groups  @param {string} omitted */
function metricTitle(sweep, groups, omitted) {
  const averaged = averagedAxes(groups, sweep).map((axis) => nameOf(axis).toLowerCase());
  const mean = averaged.length > 0 && `mean over ${averaged.join(", ")}`;
  const text = [titleOf(sweep.view.metric), mean, omitted].filter(Boolean).join("\n");
  return { text, left: "center", bottom: 58,
    textStyle: { fontSize: 12, lineHeight: 15, fontWeight: "normal", color: colour("text") } };
}

function cellOf(group, view, xs, ys, selection) {
  const chosen = group.jobs.some((job) => selection.has(job));
  const value = [xs.get(group.values[0]), view.y ? ys.get(group.values[1]) : 0, group.mean];
  return chosen ? { value, itemStyle: frame } : value;
}

/** @param {Group} group  @param {SweepPage["view"]} view */
function textOf(group, view) {
  const where = [view.x, view.y, view.panel].filter(Boolean)
    .map((axis, i) => `${nameOf(axis)}: ${pointOf(axis, group.values[i])}`);
  const several = group.count > 1 ? `\nmean of ${group.count} jobs, ${number(group.min)} to ${number(group.max)}` : "";
  return `${where.join("\n")}\n${nameOf(view.metric)} ${number(group.mean)} ${unitOf(view.metric)}${several}`;
}

const places = (values) => new Map(values.map((value, place) => [value, place]));

const shortly = (value) => number(value, 4);

/// Labels at every k-th value, so many that they stand apart; at the last one, too, if a few fewer
/// allow for that. @param room  for a label, in parts of the axis
/** @param {(string | number)[]} values  @param {number} room  @param {boolean} show */
function withRoom(values, room, show) {
  const look = axisLook();
  const steps = values.length - 1;
  const least = Math.max(1, Math.ceil(values.length * room));
  const even = Array.from({ length: least + 1 }, (_, more) => least + more)
    .find((step) => steps % step === 0) ?? least;
  return { ...look, axisLabel: { ...look.axisLabel, show, hideOverlap: false, interval: even - 1 } };
}

/// Width of the widest label, in pixels: about.
/** @param {(string | number)[]} values */
const widthOfLabels = (values) =>
  widthOfLetter * Math.max(...values.map((value) => shortly(value).length)) + 12;

/// Grids, axes and titles of the panels. Only the outer ones have axes with numbers and names.
function gridsOf(view, xs, ys, panels, { columns, lines, width, height }) {
  const step = (height - below) / lines;
  const part = 87 / columns;
  const isLowest = (index) => index + columns >= panels.length;
  const place = (index) => ({ left: `${12 + (index % columns) * part}%`, width: `${part - 3}%`,
    top: Math.floor(index / columns) * step + titleHeight, height: step - titleHeight - 4 });
  return {
    title: panels.map((panel, index) => ({ text: view.panel ? pointOf(view.panel, panel) : "", left: place(index).left,
      top: Math.floor(index / columns) * step + 2, padding: 0,
      textStyle: { fontSize: 13, width: ((part - 1) / 100) * width, overflow: "truncate",
        color: colour("text") } })),
    grid: panels.map((_, index) => place(index)),
    xAxis: panels.map((_, index) =>
      ({ gridIndex: index, type: "category", data: xs.map(shortly), name: isLowest(index) ? titleOf(view.x)
        : "", nameLocation: "middle",
        nameGap: 28,
        ...withRoom(xs, widthOfLabels(xs) / (((part - 3) / 100) * width), isLowest(index)) })),
    yAxis: panels.map((_, index) =>
      ({ gridIndex: index, type: "category", data: ys.map(shortly), name: index % columns === 0
        && view.y ? titleOf(view.y) : "", nameLocation: "middle", nameGap: 52,
        ...withRoom(ys, heightOfLabel / (step - titleHeight - 4), index % columns === 0) })),
  };
}
