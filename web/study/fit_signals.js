// SPDX-License-Identifier: Apache-2.0
// One signal of a fit: measured over predicted, and the residuals below, with the windows that are fitted and
// held back.
import { axisLook, makeChart, nothingYet } from "/core/charts.js";
import { nameOf, number, titleOf, unitOf } from "/core/format.js";
import { colour, lineColour } from "/core/theme.js";

/** @typedef {Required<Api.Schemas["FitSignalRows"][number]>} Sample */

/// Stretches of time with samples of one use.
/** @param {Sample[]} samples  @param {Sample["use"]} use */
function stretchesOf(samples, use) {
  /** @type {[number, number][]} */
  const stretches = [];
  samples.forEach((sample, index) => {
    if (sample.use !== use) return;
    if (index > 0 && samples[index - 1].use === use) stretches[stretches.length - 1][1] = sample.t_s;
    else stretches.push([sample.t_s, sample.t_s]);
  });
  return stretches;
}

/// Part of the time from the first sample to the last one that is used, in percent.
/** @param {Sample[]} samples */
function usedPart(samples) {
  const used = samples.filter(({ use }) => use !== "unused");
  if (used.length === 0) return {};
  const [first, last] = [samples[0].t_s, samples[samples.length - 1].t_s];
  const placeOf = (sample) => (100 * (sample.t_s - first)) / (last - first);
  return { start: placeOf(used[0]), end: placeOf(used[used.length - 1]) };
}

/**
 * @param {HTMLElement} element
 * @param {import("/study/fit_view.js").FitView} view
 * @param {AbortSignal} signal
 */
export function fitSignals(element, view, signal) {
  element.classList.add("double");
  /** @type {{ start?: number, end?: number }} */
  const zoom = {};
  const made = makeChart(element, () => optionOf(view.samples, { ...usedPart(view.samples), ...zoom }),
    "Measured and predicted signal over time, and their difference below", signal);
  // A chart that is drawn anew keeps the stretch that is looked at.
  made.then(({ chart }) => chart.on("datazoom", () => {
    const [{ start, end }] = /** @type {any} */ (chart.getOption()).dataZoom;
    Object.assign(zoom, { start, end });
  })).catch(() => {});
  return made;
}

/** @param {Sample[]} samples  @param {{ start?: number, end?: number }} zoom */
function optionOf(samples, zoom) {
  if (samples.length === 0) return nothingYet("", "No prediction yet.");
  const { channel } = samples[0];
  const uses = [["fitted", lineColour(2)], ["held_back", lineColour(4)]];
  const areas = (isNamed) => uses.flatMap(([use, fill]) =>
    stretchesOf(samples, /** @type {Sample["use"]} */ (use)).map(([from, to]) =>
      [{ name: isNamed ? use.replace("_", " ") : "", xAxis: from, itemStyle: { color: fill, opacity: 0.13 } },
        { xAxis: to }]));
  const marked = (isNamed) => ({ silent: true, label: { color: colour("text"), position: "insideTop" },
    data: areas(isNamed) });
  /**
   * @type {(name: string, key: "measured" | "predicted" | "residual", index: number, panel: number) => any}
   */
  const line = (name, key, index, panel) =>
    ({ type: "line", name, symbol: "none", color: lineColour(index), xAxisIndex: panel, yAxisIndex: panel,
      lineStyle: key === "measured" ? { width: 4, opacity: 0.45 } : { width: 1.3 }, sampling: "minmax",
        data: samples.map((sample) => [sample.t_s, sample[key]]) });
  const time = (panel, more) => ({ type: "value", gridIndex: panel, scale: true, min: "dataMin",
    max: "dataMax",
    ...axisLook(), ...more });
  const value = (panel, name) => ({ type: "value", gridIndex: panel, scale: true, name,
    nameLocation: "middle",
    nameGap: 50, ...axisLook() });
  const look = axisLook();
  const short = { ...look.axisLabel, formatter: (t) => number(t, 5) };
  return {
    legend: { top: 0 }, axisPointer: { link: [{ xAxisIndex: "all" }] },
    tooltip: { trigger: "axis", formatter: (lines) => textOf(lines, unitOf(channel)) },
    grid: [{ left: 75, right: 20, top: 40, height: "46%" }, { left: 75, right: 20, top: "64%", bottom: 85 }],
    xAxis: [time(0, { axisLabel: { show: false } }),
      time(1, { name: "t [s]", nameLocation: "middle", nameGap: 26,
      axisLabel: short })],
    yAxis: [value(0, titleOf(channel)),
      value(1, `residual${unitOf(channel) ? ` [${unitOf(channel)}]` : ""}`)],
    dataZoom: [{ type: "slider", xAxisIndex: [0, 1], bottom: 8, height: 26, ...zoom,
      textStyle: { color: colour("text") }, labelFormatter: (t) => `${number(t, 4)} s` },
    { type: "inside", xAxisIndex: [0, 1], zoomOnMouseWheel: "ctrl", ...zoom }],
    series: [{ ...line("measured", "measured", 0, 0), markArea: marked(true) },
      line("predicted", "predicted", 1, 0),
      { ...line("predicted less measured", "residual", 3, 1), markArea: marked(false) }],
  };
}

function textOf(lines, unit) {
  if (lines.length === 0) return "";
  return [`t ${number(lines[0].value[0], 6)} s`, ...lines.map(({ seriesName, value }) =>
    `${seriesName}: ${number(value[1])}${unit ? ` ${unit}` : ""}`)].join("\n");
}

/// Name of a signal among those of a fit: measurement and run only where there are several.
/**
 * @param {Api.Schemas["FitSignal"]} signal
 * @param {Api.Schemas["FitSignal"][]} all
 * @param {string[]} measurements
 */
export function nameOfSignal({ measurement_id: id, run, channel }, all, measurements) {
  const ofSeveral = measurements.length > 1 ? `, measurement ${measurements.indexOf(id) + 1}` : "";
  const runs = new Set(all.filter((each) => each.measurement_id === id).map((each) => each.run));
  return `${nameOf(channel)}${ofSeveral}${runs.size > 1 ? `, run ${run}` : ""}`;
}
