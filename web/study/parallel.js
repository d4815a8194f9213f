// SPDX-License-Identifier: Apache-2.0
// Parallel coordinates: a line for each job over the axes and some metrics. Brushing an axis selects jobs.
import { makeChart, nothingYet } from "/core/charts.js";
import { h } from "/core/dom.js";
import { exact, number, plural, titleOf } from "/core/format.js";
import { colour, linePalette } from "/core/theme.js";
import { none, onceFor, valueOf, valuesOf } from "/study/data.js";
import { whyEmpty } from "/study/missing.js";
import { extremesOf, widened } from "/study/span.js";

const [left, right] = [60, 90];
const leastGap = 84;  // pixels from axis to axis
const [widthOfLetter, lineHeight] = [6.2, 13];  // pixels of the names of axes, about
const many = 2000;  // lines, which are drawn so thin that their density is seen
const someMetrics = ["peak_contact_force_n", "impact_count", "rms_slider_acceleration_m_s2"];

/** @param {HTMLElement} element  @param {SweepPage} sweep  @param {AbortSignal} signal */
export function parallelChart(element, sweep, signal) {
  /** @type {Api.Row[]} */
  let shown = [];
  let isOwn = () => false;
  const around = h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Axes" });
  element.replaceWith(around);
  around.append(element);
  const made = makeChart(element, () => {
    // On a phone the axes are pushed along: closer to each other they would have no room for their names.
    element.style.minWidth = `${left + right + leastGap * (layOut(sweep).columns.length - 1)}px`;
    const plan = planOf(sweep, element.clientWidth);
    shown = plan.shown;
    // An optimisation has no help of its own.
    sweep.help?.replaceChildren("Drag along an axis to select jobs; click the axis to clear its selection. ",
      noteOf(layOut(sweep)));
    return plan.option;
  }, "Parallel coordinates of all jobs; the table below has the same numbers", signal);
  made.then(({ chart }) => chart.on("axisareaselected", () => {
    const [series] = chart.getModel().getSeries();
    const active = series.getRawIndicesByActiveState("active");
    const ids = active.length === shown.length ? [] : active.map((index) => shown[index].job_id);
    const { rows, selection, view: { metric } } = sweep;
    isOwn = () => sweep.rows === rows && sweep.view.metric === metric && selection.size === ids.length
      && ids.every((id) => selection.has(id));
    selection.set(ids);
  })).catch(() => {});
  // A selection that brushes have made is not drawn, however late that is asked for: drawing ends the brushing.
  return made.then((chart) => ({ ...chart, draw: () => {
    if (isOwn()) return;
    isOwn = () => false;
    chart.draw();
  } }));
}

// Beyond the extremes there is room, from where a brush can begin.
const beyond = ({ min, max }) => 0.05 * (max - min || Math.abs(max) || 1);
const ends = (extremes) => widened(extremes) ?? extremes;
const roomy = { scale: true, min: (extremes) => ends(extremes).min - beyond(ends(extremes)),
  max: (extremes) => ends(extremes).max + beyond(ends(extremes)) };

/// The columns, those that most jobs have a value of first: a line then ends where its job has no further values.
/// One that would lead across a gap
/// is left out, for there is no way to draw it that tells the truth.
/** @param {SweepPage} sweep */
const layOut = ({ rows, axes, metrics, view }) => onceFor(rows, `lines up to ${view.metric} over ${axes}`,
  () => arrange({ rows, axes, metrics, view }));

/** @param {Pick<SweepPage, "rows" | "axes" | "metrics" | "view">} sweep */
function arrange({ rows, axes, metrics, view }) {
  const computed = rows.filter((row) => row.state === "succeeded");
  const names = [...axes, ...new Set([...someMetrics.filter((metric) => metrics.includes(metric)), view.metric])];
  const columns = names.map((name) => {
    const values = valuesOf(computed, name);
    const isNumeric = values.every((value) => typeof value === "number" || value === none);
    const isMissing = (row) => isNumeric && typeof row[name] !== "number";
    return { name, values, isNumeric, isMissing, missing: computed.filter(isMissing).length };
  }).filter(({ name, missing }) => name === view.metric || missing < computed.length).sort((a,
  b) => a.missing - b.missing);
  const last = columns[columns.length - 1];
  const hasGap = (row) => columns.some((column, index) => index > 0 && columns[index - 1].isMissing(row)
    && !column.isMissing(row));
  const shown = computed.filter((row) => !hasGap(row));
  return { columns, shown, leftOut: computed.length - shown.length, short: shown.filter((row) => last.isMissing(row))
    .length };
}

/// Note on jobs that the lines do not show; empty if they show all.
/** @param {{ leftOut: number, short: number }} counts */
function noteOf({ leftOut, short }) {
  return [short > 0 && `${plural(short, "line")} ${short === 1 ? "ends" : "end"} early, where the job has no further `
    + `values.`,
    leftOut > 0 && `${plural(leftOut, "job")} with a gap between values ${leftOut === 1 ? "is" : "are"} left `
      + `out.`].filter(Boolean).join(" ");
}

/** @type {(values: any[]) => number[]} */
const numbersOf = (values) => values.filter((value) => typeof value === "number");
/** @type {(values: any[]) => boolean} */
const isConstant = (values) => numbersOf(values).length === 1;

/// Labels away from the ends of the axis; of one value that one alone.
/** @param {any[]} values */
const labelsOfNumbers = (values) => (isConstant(values) ? { customValues: numbersOf(values) }
  : { showMinLabel: false, showMaxLabel: false });

/// Title of a column in lines as wide as the room, in pixels. ECharts cuts off names wider than the gap of the axes.
/** @param {string} name  @param {number} room */
function titleLines(name, room) {
  const most = Math.floor(room / widthOfLetter);
  /** @type {string[]} */
  const lines = [];
  for (const word of titleOf(name).split(" ")) {
    const longer = `${lines.at(-1)} ${word}`;
    if (lines.length > 0 && longer.length <= most) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

/// An axis, with its name above or below it in turn.
function dimensionOf({ values, isNumeric }, dim, lines) {
  return { dim, name: lines.join("\n"), nameLocation: dim % 2 === 0 ? "end" : "start",
    nameTextStyle: { color: colour("text"), fontSize: 11, lineHeight },
    axisLine: { lineStyle: { color: colour("quiet") } },
    // With a rim in the colour of the ground, for lines run below them.
    axisLabel: { color: colour("text"), textBorderColor: colour("card"), textBorderWidth: 4, formatter: (value) => (isNumeric ? number(value) : exact(value)),
      ...(isNumeric ? labelsOfNumbers(values) : {}) },
    axisTick: isNumeric && isConstant(values) ? { customValues: numbersOf(values).slice(0, 1) } : {},
    ...(isNumeric ? roomy : { type: "category", data: values.map(String) }) };
}

/** @param {SweepPage} sweep  @param {number} width */
function planOf(sweep, width) {
  const { view, selection } = sweep;
  const { columns, shown } = layOut(sweep);
  if (shown.length === 0) return { shown, option: nothingYet(whyEmpty(sweep)) };
  const peaks = shown.map((row) => row[view.metric]).filter((value) => typeof value === "number");
  const gap = (width - left - right) / Math.max(1, columns.length - 1);
  const names = columns.map(({ name }, dim) => titleLines(name, Math.min(gap, dim === 0 ? 2 * left : 2 * right)));
  const most = lineHeight * Math.max(...names.map(({ length }) => length));
  return { shown, option: {
    parallel: { left, right, top: 24 + most, bottom: 29 + most, parallelAxisDefault: axisDefaults() },
    parallelAxis: columns.map((column, dim) => dimensionOf(column, dim, names[dim])),
    visualMap: { show: false, ...ends(extremesOf(peaks)),
      dimension: columns.findIndex(({ name }) => name === view.metric), inRange: { color: linePalette() } },
    series: [{ type: "parallel", smooth: false, progressive: 400, progressiveThreshold: 1000,
      lineStyle: shown.length > many ? { width: 1, opacity: 0.15 } : { width: 1.5, opacity: 0.75 }, inactiveOpacity: 0.06,
      data: shown.map((row) => lineOf(row, columns, view.metric, selection)) }],
  } };
}

/// Options of all axes.
function axisDefaults() {
  return { nameLocation: "start", nameGap: 18,
    areaSelectStyle: { color: colour("accent"), opacity: 0.35 } };
}

/// A value alone where that is enough: there may be ten thousand.
function lineOf(row, columns, metric, selection) {
  const value = columns.map((column) => cellOf(row, column));
  // The palette knows no colour for what has no value of the metric.
  const uncoloured = typeof row[metric] === "number" ? null : { color: colour("quiet") };
  if (!uncoloured && selection.size === 0) return value;
  return { value, visualMap: uncoloured === null, lineStyle: { ...uncoloured, ...weightOf(row, selection) } };
}

/// Width and opacity of a line; the defaults if nothing is selected.
function weightOf(row, selection) {
  if (selection.size === 0) return {};
  return selection.has(row.job_id) ? { width: 3, opacity: 1 } : { opacity: 0.1 };
}

/// "-" is what ECharts takes for no number; of words the sign for none is one of the values.
function cellOf(row, { name, isNumeric }) {
  const value = valueOf(row, name);
  if (!isNumeric) return String(value);
  return value === none ? "-" : value;
}
