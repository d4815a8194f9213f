// SPDX-License-Identifier: Apache-2.0
// Makes charts with ECharts, in the page's colours.
import { h } from "/core/dom.js";
import { save, saveCanvas } from "/core/download.js";
import { number } from "/core/format.js";
import { libraryLoader } from "/core/modules.js";
import { colour, onColours } from "/core/theme.js";

/// Loads ECharts; called early, it is there when the data are.
export const loadCharts = libraryLoader("charts", () => import("/lib/echarts.js"));

const disposeMs = 1000;
let warm = null;

/// Loads ECharts and draws something small that nobody sees, once. A browser compiles code at its first use.
/// Before the data are there, this shortens the first charts by a tenth of a second.
export function warmUpCharts() {
  warm ??= loadCharts().then(drawUnseen).catch((error) => {
    warm = null;
    throw error;
  });
  return warm;
}

function drawUnseen(echarts) {
  const chart = echarts.init(h("div"), null, { width: 300, height: 200 });
  const values = Array.from({ length: 30 }, (_, place) => [place % 6, Math.floor(place / 6), place]);
  chart.setOption(inPageColours({
    legend: {}, tooltip: {}, title: { text: "-" }, grid: [{}, {}],
    xAxis: [{ name: "-" }, { gridIndex: 1, type: "category", data: [..."012345"] }],
    yAxis: [{ name: "-" }, { gridIndex: 1, type: "category", data: [..."01234"] }],
    visualMap: { min: 0, max: 30, calculable: true, dimension: 2, seriesIndex: 1,
      inRange: { color: ["#000", "#fff"] } },
    series: [{ type: "line", name: "-", data: values.slice(0, 6) },
      { type: "heatmap", xAxisIndex: 1, yAxisIndex: 1, data: values }],
  }));
  chart.getZr().flush();
  // A frame that is still to be painted must not meet a chart that is gone.
  chart.on("finished", () => setTimeout(() => chart.isDisposed() || chart.dispose(), disposeMs));
}

/// The parts of an option that all charts share.
function inPageColours(option) {
  const text = { color: colour("text") };
  return { textStyle: { fontFamily: "system-ui, sans-serif" }, backgroundColor: "transparent", animation: false,
    aria: { enabled: true },
    ...option,
    legend: option.legend && { type: "scroll", textStyle: text, pageTextStyle: text, ...option.legend },
    tooltip: option.tooltip && { renderMode: "richText", confine: true, backgroundColor: colour("card"),
      borderColor: colour("line"), textStyle: text, ...option.tooltip } };
}

/// Option of a chart without data. @param why  reason, in a line of its own  @param told  the first line
export function nothingYet(why = "", told = "No job has a value of this metric.") {
  return { title: { text: [told, why].filter(Boolean).join("\n"), left: "center", top: "middle",
    textStyle: { color: colour("quiet"), fontSize: 14, lineHeight: 22, fontWeight: "normal" } } };
}

/// Colours and lines of an axis.
export function axisLook() {
  const line = { lineStyle: { color: colour("line") } };
  return { axisLine: line, axisTick: line, splitLine: line, axisLabel: { color: colour("text"), hideOverlap: true },
    nameTextStyle: { color: colour("text") } };
}

/// Look of an axis whose labels are written as all numbers: 1e−6, not 0.000001.
export function numberLook() {
  const look = axisLook();
  return { ...look, axisLabel: { ...look.axisLabel, formatter: (value) => number(value) } };
}

/// A chart that fills its element and follows its size and the page's colours.
/// @param makeOption  gives ECharts' option, anew for each drawing; null if there is nothing to draw
/// @param label       what a screen reader says of it
/**
 * @param {HTMLElement} element
 * @param {() => any} makeOption
 * @param {string} label
 * @param {AbortSignal} signal
 */
export async function makeChart(element, makeOption, label, signal) {
  if (!element.hasChildNodes()) element.append(h("p", { class: "quiet small loading" },
    "Loading the chart …"));
  const echarts = await loadCharts();
  signal.throwIfAborted();
  element.replaceChildren();
  const chart = echarts.init(element);
  element.setAttribute("role", "img");
  element.setAttribute("aria-label", label);
  // A chart of its element's size is not drawn twice.
  const fit = () => {
    if (chart.getWidth() !== element.clientWidth || chart.getHeight() !== element.clientHeight) chart.resize();
  };
  const draw = () => {
    const option = inPageColours(makeOption() ?? nothingYet());
    fit();
    chart.setOption(option, { notMerge: true });
  };
  const sizes = new ResizeObserver(fit);
  sizes.observe(element);
  onColours(draw, signal);
  signal.addEventListener("abort", () => {
    sizes.disconnect();
    chart.dispose();
  });
  draw();
  return { chart, draw,
    savePng: (name) => saveCanvas(
      chart.renderToCanvas({ pixelRatio: 2, backgroundColor: colour("card") }), `${name}.png`),
    saveSvg: (name) => saveSvg(echarts, element, inPageColours(makeOption() ?? nothingYet()), name) };
}

function saveSvg(echarts, element, option, name) {
  const drawing = echarts.init(null, null,
    { renderer: "svg", ssr: true, width: element.clientWidth, height: element.clientHeight });
  drawing.setOption({ ...option, backgroundColor: colour("card") });
  save(drawing.renderToSVGString(), `${name}.svg`, "image/svg+xml");
  drawing.dispose();
}

/// Buttons that save what a chart shows. @param find  gives what makeChart has made
export function saveButtons(find, name) {
  return h("span", { class: "actions" },
    h("button", { onclick: () => find()?.savePng(name()) }, "PNG"),
    h("button", { onclick: () => find()?.saveSvg(name()) }, "SVG"));
}
