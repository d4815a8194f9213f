// SPDX-License-Identifier: Apache-2.0
// Sets the stretch of time that all plots show.
import { h } from "/core/dom.js";
import { number } from "/core/format.js";
import { finerButton } from "/run/finer.js";
import { overview } from "/run/overview.js";
import { peakTime } from "/run/peaks.js";

const aroundPeak = 0.02;
const help = "Plots: drag or turn the wheel to zoom, Shift + drag to pan, double-click for the whole run; touch "
  + "screen: two fingers "
  + "zoom, one pans; keys: ← → + − 0. Strip: drag to choose the time window.";

/// @param job    with parameters and metrics; the buttons lead to its steady window and its peak
/// @param trace  that the strip shows: its envelope, if there is one
/**
 * @param {TimeWindow} times
 * @param {Api.Job} job
 * @param {Pick<Trace, "channel" | "envelope">} trace
 * @param {AbortSignal} signal
 */
export function timeBar(times, job, { channel, envelope = [channel] }, signal) {
  const slider = (label, moved) => {
    const input = h("input", { type: "range", min: 0, max: times.end, step: times.end / 10000, class: "wide",
      "aria-label": label,
      oninput: () => moved(Number(input.value)) });
    return input;
  };
  const from = slider("From [s]", (value) => times.set(value, Math.max(times.to, value + times.least)));
  const to = slider("To [s]", (value) => times.set(Math.min(times.from, value - times.least), value));
  const text = h("output", { class: "small" });
  const draw = () => {
    from.value = String(times.from);
    to.value = String(times.to);
    text.textContent = `${number(times.from, 6)} s to ${number(times.to, 6)} s`;
  };
  times.addEventListener("change", draw, { signal });
  draw();
  const [finely, told] = finerButton(times, job, signal);
  const { run_up_s: runUp } = job.parameters;
  const peak = peakTime(job, channel);
  const jump = (name, go) => h("button", { onclick: go }, name);
  return h("section", { class: "card tight", "aria-label": "Time" },
    h("p", { class: "actions" }, h("strong", {}, "Time"), jump("Whole run", () => times.reset()),
      runUp < times.end ? jump("Steady window", () => times.set(runUp, times.end)) : null,
      peak !== undefined ? jump("Peak", () => times.set(peak - aroundPeak, peak + aroundPeak)) : null,
      // last: their length changes
      finely, text, told),
    overview(job, envelope, times, signal),
    h("div", { class: "columns even" }, h("label", { class: "small quiet" }, "from", from),
      h("label", { class: "small quiet" }, "to", to)),
    h("p", { class: "quiet small" }, help));
}
