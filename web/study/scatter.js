// SPDX-License-Identifier: Apache-2.0
// The jobs as points over any two of their numbers and parameters, in the colour of a third. A click selects.
import { axisLook, makeChart, nothingYet, numberLook } from "/core/charts.js";
import { choice, h, part } from "/core/dom.js";
import { nameOf, pointOf, titleOf } from "/core/format.js";
import { colour, lineColour, linePalette, paletteColour, ring } from "/core/theme.js";
import { colourBar, colourBarHeight } from "/study/colour_bar.js";
import { scaleOf } from "/study/curves.js";
import { hasScale, none, valueOf, valuesOf } from "/study/data.js";
import { legendOf } from "/study/legend.js";
import { extremesOf, fittedAxis, spansDecades } from "/study/span.js";

const left = 75;
const fewTicks = 12;
const many = 2000;  // points, which are drawn so small and clear that their density is seen
const classes = 16;  // of the colours of so many points

/** @param {HTMLElement} element  @param {SweepPage} sweep  @param {AbortSignal} signal */
export function scatterChart(element, sweep, signal) {
  const made = makeChart(element, () => optionOf(sweep, element.clientWidth),
    "Jobs over two of their numbers; the table below has the same numbers", signal);
  made.then(({ chart }) => chart.on("click", ({ data }) => {
    const job = /** @type {any} */ (data)?.[3];
    if (job) sweep.selection.toggle([job]);
  })).catch(() => {});
  return made;
}

/// Columns of the axes and of the colour: as chosen, else the metric over the first axis.
/** @param {SweepPage} sweep */
function namesOf({ view, axes, metrics }) {
  const other = metrics.find((metric) => metric !== view.metric && /^peak_.*force/.test(metric)) ?? view.x;
  const x = view.scatterX || other;
  const varied = axes.filter((axis) => axis !== x);
  const usual = varied.includes(view.x) ? view.x : varied[0] ?? "";
  return { x, y: view.scatterY || view.metric, c: view.scatterColour === "none" ? "" : view.scatterColour
    || usual };
}

/** @param {SweepPage} sweep  @param {number} width */
function optionOf(sweep, width) {
  const { rows, selection, axes } = sweep;
  const { x, y, c } = namesOf(sweep);
  const [xAxis, yAxis] = [axisOf(rows, x, axes), axisOf(rows, y, axes)];
  const shown = rows.filter((row) => xAxis.has(row) && yAxis.has(row) && row.state === "succeeded");
  if (shown.length === 0) return nothingYet("", "No job has both values.");
  const isScale = c !== "" && hasScale(rows, c);
  const point = (row) => [xAxis.at(row), yAxis.at(row), isScale ? row[c] ?? "-" : 0, row.job_id];
  const isDense = shown.length > many;
  const groups = groupsOf(shown, { c, isScale, isDense, numbers: isScale ? numbersOf(rows, c) : [], name: nameOf(y) });
  const chosen = shown.filter((row) => selection.has(row.job_id));
  const numbers = isScale ? numbersOf(rows, c) : [];
  const legend = legendOf(groups.map(({ name }) => name), width);
  const hasLegend = !isScale && groups.length > 1;
  const byId = new Map(shown.map((row) => [row.job_id, row]));
  return {
    grid: { left, right: 25, top: 16 + (isScale ? colourBarHeight : hasLegend ? legend.height : 0),
      bottom: 50 },
    legend: { ...legend.option, show: hasLegend }, graphic: isScale
      ? colourBar(c, numbers, ticksOf(numbers), width, left) : [],
    tooltip: { formatter: ({ data }) => textOf(byId.get(data[3]), [...new Set([...axes, x, y])]) },
    // Values decades apart would all lie at the end of the palette: the chart has their logarithms.
    ...(isScale && !isDense ? { visualMap: { show: false, ...mapOf(numbers), dimension: 2, seriesIndex: 0,
      inRange: { color: linePalette() } } } : {}),
    xAxis: { ...xAxis.option, name: titleOf(x), nameLocation: "middle", nameGap: 28 },
    yAxis: { ...yAxis.option, name: titleOf(y), nameLocation: "middle", nameGap: 55 },
    series: [...groups.map((group, index) => ({ type: "scatter", name: group.name,
      color: group.colour ?? lineColour(index),
      ...(isDense ? { large: true, largeThreshold: 0, symbolSize: 3, itemStyle: { opacity: 0.4 } }
        : { symbolSize: 7, itemStyle: { opacity: 0.8 } }),
      data: group.rows.map(isScale && !isDense && spansDecades(numbers)
        ? (row) => point(row).with(2, Math.log10(row[c])) : point) })),
    { type: "scatter", name: "selected", silent: true, symbolSize: 15, z: 5, data: chosen.map(point),
      itemStyle: ring }].filter(({ data }) => data.length > 0),
  };
}

/** @param {Api.Row[]} rows  @param {string} column */
const numbersOf = (rows, column) => valuesOf(rows, column).filter((value) => typeof value === "number");

/// Points of one colour or scale. Of many points on a scale each class of its colours is a group: one shape for all
/// points of a group is drawn many times faster than a shape for each point.
/** @param {Api.Row[]} shown */
function groupsOf(shown, { c, isScale, isDense, numbers, name }) {
  if (c === "" || (isScale && !isDense)) return [{ name, rows: shown }];
  if (!isScale) {
    return valuesOf(shown, c).map((value) => ({ name: pointOf(c, value),
      rows: shown.filter((row) => valueOf(row, c) === value) }));
  }
  const scale = scaleOf(numbers);
  const classOf = (row) => (typeof row[c] === "number" ? Math.min(classes - 1, Math.floor(classes * scale(row[c]))) : -1);
  /** @type {Map<number, Api.Row[]>} */
  const byClass = new Map();
  for (const row of shown) {
    const ofClass = byClass.get(classOf(row)) ?? [];
    byClass.set(classOf(row), ofClass);
    ofClass.push(row);
  }
  return [...byClass].map(([k, rows]) => ({ name, rows,
    colour: k < 0 ? colour("quiet") : paletteColour((k + 0.5) / classes) }));
}

/// Numbers with a tick on the colour bar.
const ticksOf = (numbers) => (numbers.length <= fewTicks ? numbers
  : [numbers[0], numbers[Math.floor(numbers.length / 2)], numbers[numbers.length - 1]]);

function mapOf(numbers) {
  return extremesOf(spansDecades(numbers) ? numbers.map(Math.log10) : numbers);
}

/// Axis of numbers, logarithmic for a parameter with values decades apart, or of words in the order asked
/// for.
/** @param {Api.Row[]} rows  @param {string} name  @param {string[]} axes */
function axisOf(rows, name, axes) {
  const values = valuesOf(rows, name).filter((value) => value !== none);
  if (values.every((value) => typeof value === "number")) {
    const isLog = axes.includes(name) && spansDecades(values);
    return { has: (row) => typeof row[name] === "number", at: (row) => row[name],
      option: { ...(isLog ? { type: "log" } : fittedAxis), ...numberLook() } };
  }
  return { has: (row) => valueOf(row, name) !== none, at: (row) => values.indexOf(valueOf(row, name)),
    option: { type: "category", data: values.map(String), ...axisLook() } };
}

/** @param {Api.Row | undefined} row  @param {string[]} names */
function textOf(row, names) {
  if (!row) return "";
  return names.map((name) => `${nameOf(name)}: ${pointOf(name, typeof row[name] === "number" ? Number(row[name].toPrecision(6)) : valueOf(row, name))}`)
    .join("\n");
}

/// Selects of the two axes and of the colour. @param changed  is called when one has been chosen
/** @param {SweepPage} sweep  @param {() => void} changed */
export function scatterChoice(sweep, changed) {
  const all = [...sweep.axes, ...sweep.metrics].map((name) => [name, titleOf(name)]);
  const select = (label, key, options) => choice(label, options, "", (chosen) => { sweep.view[key] = chosen; changed(); });
  const selects = { x: select("Along", "scatterX", all), y: select("Upwards", "scatterY", all),
    c: select("Colour", "scatterColour", [["none", "none"], ...all]) };

  function draw() {
    const names = namesOf(sweep);
    for (const [key, element] of Object.entries(selects)) {
      const value = names[key] || "none";
      part("select", element).value = value;
      Object.assign(element.dataset, { kind: "metrics", quantity: value });
    }
  }

  return { element: h("span", { class: "actions" }, ...Object.values(selects)), draw };
}
