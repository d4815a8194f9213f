// SPDX-License-Identifier: Apache-2.0
// The whole run in a strip. The stretch that all plots show is marked in it; drawing over the strip sets another one.
import { h, laidOut } from "/core/dom.js";
import { nameOfChannel } from "/core/format.js";
import { colour, lineColour, onColours } from "/core/theme.js";
import { loadUplot } from "/core/uplot.js";
import { loadAligned } from "/run/plot_data.js";

const height = 64;

/// @param envelope  channels: the least and the largest of one quantity, or one alone
/**
 * @param {Api.Job} job
 * @param {string[]} envelope
 * @param {TimeWindow} times
 * @param {AbortSignal} signal
 */
export function overview(job, envelope, times, signal) {
  const element = h("div",
    { class: "overview", role: "img",
      "aria-label": `${nameOfChannel(envelope[0].replace("_min_", "_"))} of the whole run, `
        + "with the stretch that the plots "
        + `show. The sliders below set it too.` });
  make(element, job, envelope, times, signal)
    .catch((error) => { if (error.name !== "AbortError") element.textContent = error.message; });
  return element;
}

/**
 * @param {HTMLElement} element
 * @param {Api.Job} job
 * @param {string[]} envelope
 * @param {TimeWindow} times
 * @param {AbortSignal} signal
 */
async function make(element, job, envelope, times, signal) {
  const uPlot = await loadUplot();
  await laidOut(element, signal);
  // Only the extremes: between them lies the acceleration itself.
  const [other, trace = other] = envelope.map((channel) => ({ job: job.id, channel }));
  const whole = { isWhole: true, start: times.start, from: 0, to: times.end, end: times.end,
    length: times.end };
  const data = await loadAligned(uPlot, [trace, other], whole, element.clientWidth, signal);
  let plot = null;
  const draw = () => {
    plot?.destroy();
    plot = new uPlot(optionsOf(element.clientWidth, times), data, element);
    mark(plot, times);
  };
  draw();
  times.addEventListener("change", () => mark(plot, times), { signal });
  onColours(draw, signal);
  const sizes = new ResizeObserver(() => { plot.setSize({ width: element.clientWidth, height }); mark(plot, times); });
  sizes.observe(element);
  signal.addEventListener("abort", () => { sizes.disconnect(); plot.destroy(); });
}

function optionsOf(width, times) {
  const line = { stroke: lineColour(0), width: 1, points: { show: false } };
  return {
    width, height, legend: { show: false }, padding: [4, 8, 0, 8],
    scales: { x: { time: false, range: () => [0, times.end] } },
    series: [{}, line, line], bands: [{ series: [1, 2], fill: line.stroke }],
    axes: [{ size: 22, stroke: colour("text"), font: "11px system-ui", grid: { show: false }, ticks: { show: false },
      values: (_, values) => values.map((value) => `${value} s`) }, { show: false }],
    cursor: { x: false, y: false, points: { show: false }, drag: { x: true, y: false, setScale: false } },
    hooks: { ready: [(plot) => mark(plot, times)], setSelect: [(plot) => {
      const { left, width: wide } = plot.select;
      if (wide >= 3) times.set(plot.posToVal(left, "x"), plot.posToVal(left + wide, "x"));
      else mark(plot, times);
    }] },
  };
}

function mark(plot, times) {
  const left = plot.valToPos(times.from, "x");
  plot.setSelect({ left, top: 0, width: plot.valToPos(times.to, "x") - left,
    height: plot.bbox.height / devicePixelRatio }, false);
}
