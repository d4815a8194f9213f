// SPDX-License-Identifier: Apache-2.0
// Channels of one or several jobs over time. What it shows is fetched for the stretch of time that is looked at, so
// no spike is lost.
import { h, laidOut } from "/core/dom.js";
import { debounce, latest, retryWhileUnreachable, throttle } from "/core/live.js";
import { onColours } from "/core/theme.js";
import { loadUplot } from "/core/uplot.js";
import { captioned } from "/run/captioned.js";
import { watchFingers } from "/run/fingers.js";
import { loadAligned } from "/run/plot_data.js";
import { plotOptions } from "/run/plot_options.js";
import { listenToKeys } from "/run/time_window.js";

const refineMs = 120;  // where nothing is there to be shown yet
const settleMs = 250;  // where it only gets finer

/// @param traces  a list of {job, channel, name, colour (a function), dash, envelope: [least, largest] or nothing}
/// @param times   the window that all plots share
/**
 * @param {HTMLElement} element
 * @param {{ traces: Trace[], times: TimeWindow, height: number, label: string, signal: AbortSignal }} shown
 */
export async function timePlot(element, { traces, times, height, label, signal }) {
  element.classList.add("time-plot");
  element.style.minHeight = `${height}px`;  // the parts below do not jump when the plot comes
  const uPlot = await loadUplot();
  await laidOut(element, signal);
  /** @type {InstanceType<typeof uPlot> | null} */
  let plot = null;
  /** @type {number[][] | null} */
  let data = null;
  let isSeen = true;
  const now = h("div", { class: "now", hidden: true });
  const place = h("div");
  // in the page before it says something, or it would not be read out
  const trouble = h("p", { class: "trouble", role: "status" });
  element.append(place, trouble);
  const tell = (text) => { trouble.textContent = text; };

  const load = latest(async (current) => {
    const find = () => loadAligned(uPlot, traces, times, element.clientWidth, current);
    data = await retryWhileUnreachable(find, tell, current);
    if (plot) plot.setData(data, false);
    else make();
    follow();
  }, signal);
  const tryLoad = () => load().catch((error) => tell(error.message));

  function make() {
    plot?.destroy();
    plot = new uPlot(plotOptions(traces, times, element.clientWidth, height), data, place);
    plot.over.append(now);
    tellLegend();
    watchPointer(plot, times);
    watchFingers(plot.over, times);
  }

  /// The keyboard reaches a legend that is wider than the plot, to move it along.
  function tellLegend() {
    const legend = element.querySelector(".u-legend");
    if (!legend) return;
    if (legend.scrollWidth > legend.clientWidth) legend.setAttribute("tabindex", "0");
    else legend.removeAttribute("tabindex");
  }

  function showInstant() {
    if (!plot) return;
    const inside = times.instant >= times.from && times.instant <= times.to;
    now.hidden = !inside;
    if (inside) now.style.transform = `translateX(${plot.valToPos(times.instant, "x")}px)`;
  }

  function follow() {
    if (plot && isSeen) plot.batch(() => {
      plot.setScale("x", { min: times.from, max: times.to });
    });
    showInstant();
  }

  const fetchSoon = throttle(() => signal.aborted || tryLoad(), refineMs);
  const fetchLater = debounce(() => signal.aborted || tryLoad(), settleMs);
  // While the window moves within the loaded data these are drawn; finer data are fetched when it stands still.
  const isThere = () => data && times.from >= data[0][0] && times.to <= data[0][data[0].length - 1];
  times.addEventListener("change", () => { follow(); if (isThere()) fetchLater(); else fetchSoon(); }, { signal });
  times.addEventListener("instant", showInstant, { signal });
  onColours(() => data && make(), signal);
  const sizes = new ResizeObserver(() => {
    plot?.setSize({ width: element.clientWidth, height });
    tellLegend();
  });
  sizes.observe(element);
  // Plots out of sight are not drawn until they come into sight: a page has many, and all move at every frame.
  const sight = new IntersectionObserver((entries) =>
    { isSeen = entries[entries.length - 1].isIntersecting; follow(); });
  sight.observe(element);
  signal.addEventListener("abort", () => { sizes.disconnect(); sight.disconnect(); plot?.destroy(); });
  element.setAttribute("role", "group");
  element.setAttribute(
    "aria-label", `${label}, over time. Arrow keys move, plus and minus zoom, 0 shows the whole run.`);
  listenToKeys(element, times);
  await tryLoad();
  return { plot: () => plot, canvas: () => paint(plot, label, traces) };
}

/// The plot below its title, and the names of its curves if there are several.
function paint(plot, title, traces) {
  const curves = traces.length > 1 ? traces.map((trace) => ({ name: trace.name, ink: trace.colour() })) : [];
  return captioned(plot.ctx.canvas, [{ name: title }, ...curves]);
}

/// The wheel zooms about the pointer; dragging with Shift, or with two fingers on a pad, moves.
function watchPointer(plot, times) {
  const { over } = plot;
  over.addEventListener("wheel", (event) => {
    event.preventDefault();
    if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) times.pan(event.deltaX / over.clientWidth);
    else times.zoom(event.deltaY < 0 ? 0.8 : 1.25, plot.posToVal(event.offsetX, "x"));
  }, { passive: false });
  over.addEventListener("pointerdown", (event) => {
    if (!event.shiftKey) return;
    over.setPointerCapture(event.pointerId);
    let last = event.clientX;
    const move = (moved) => {
      times.pan((last - moved.clientX) / over.clientWidth);
      last = moved.clientX;
    };
    over.addEventListener("pointermove", move);
    over.addEventListener("pointerup", () => over.removeEventListener("pointermove", move), { once: true });
  });
}
