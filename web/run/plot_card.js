// SPDX-License-Identifier: Apache-2.0
// A plot over time in a card, with its buttons.
import { h } from "/core/dom.js";
import { saveCanvas } from "/core/download.js";
import { nameOfChannel, unitOf } from "/core/format.js";
import { term } from "/core/quantities.js";
import { lineColour } from "/core/theme.js";
import { labelsOf } from "/run/labels.js";
import { timePlot } from "/run/time_plot.js";

/// @param note   what stands below the plot; empty: nothing
/// @param close  is called to take the card away; without it there is no such button
/**
 * @param {string} title
 * @param {{ traces: Trace[], times: TimeWindow, height: number, signal: AbortSignal, note?: string,
 *   close?: () => void, tools?: HTMLElement[] }} more
 */
export function plotCard(title, { traces, times, height, signal, note = "", close, tools = [] }) {
  const element = h("div");
  const [channel, ...others] = new Set(traces.map((trace) => trace.channel));
  const [unit, ...units] = new Set(traces.map((trace) => unitOf(trace.channel)));
  const heading = unit && units.length === 0 && !title.endsWith("]") ? `${title} [${unit}]` : title;
  /** @type {Awaited<ReturnType<typeof timePlot>> | null} */
  let made = null;
  timePlot(element, { traces, times, height, label: title, signal }).then((plot) => { made = plot; })
    .catch((error) => { element.textContent = error.message; });
  return h("section", { class: "card" },
    h("div", { class: "head" }, h("h2", {}, others.length === 0 ? term("channels", channel, heading) : heading),
    h("span", { class: "actions" }, tools,
      h("button", { onclick: () => made && saveCanvas(made.canvas(), `${title}.png`) }, "PNG"),
      close ? h("button", { onclick: close, "aria-label": `Remove ${title}` }, "✕") : null)), element, note && h("p",
      { class: "quiet small" }, note));
}

/// Names without the words at their ends that the title says already: of "Contact force" the "Crank pin".
/** @param {string[]} names  @param {string} title */
function shortened(names, title) {
  const said = title.toLowerCase().split(" ");
  return names.map((name) => {
    const words = name.split(" ");
    while (words.length > 1 && said.includes(words[words.length - 1].toLowerCase())) words.pop();
    return words.join(" ");
  });
}

/// Traces of some channels for each of the jobs. @param channels  names, or {channel, envelope}
/// @param axes  of the jobs' sweep  @param title  of their plot
/**
 * @param {Api.Job[]} jobs
 * @param {(string | Pick<Trace, "channel" | "envelope">)[]} channels
 * @param {string[]} axes
 * @param {string} title
 * @returns {Trace[]}
 */
export function tracesOf(jobs, channels, axes, title = "") {
  const several = jobs.length > 1;
  const labels = labelsOf(jobs, axes);
  const paths = channels.map((each) => (typeof each === "string" ? each : each.channel));
  const full = paths.map(nameOfChannel);
  const isPlain = new Set(paths.map((path) => unitOf(path))).size === 1;
  const names = isPlain && channels.length > 1 ? shortened(full, title) : full;
  return jobs.flatMap((job, j) => channels.map((each, c) => {
    const { channel, envelope = undefined } = typeof each === "string" ? { channel: each } : each;
    const name = channels.length > 1 || !several ? names[c] : "";
    return { job: job.id, channel, envelope,
      name: [name, several ? labels[j] : ""].filter(Boolean).join(", "),
      colour: () => lineColour(j * channels.length + c) };
  }));
}
