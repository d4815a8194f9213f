// SPDX-License-Identifier: Apache-2.0
// A channel once a turn over a number that is swept: one line of points where the motion repeats itself, a cloud
// where it does not.
import { findAnalysis, findTrajectory } from "/core/api.js";
import { makeChart } from "/core/charts.js";
import { choice, h } from "/core/dom.js";
import { number, plural, pointOf, titleOf } from "/core/format.js";
import { latest, retryWhileUnreachable } from "/core/live.js";
import { quantityChoice } from "/core/quantities.js";
import { lineColour } from "/core/theme.js";
import { acrossAxis, valueAxis, where } from "/analysis/parts.js";

const mostNamed = 12;  // combinations of axes, each in a colour of its own
const ofRpsup = ["journal_x_mm", "journal_y_mm", "slider_acceleration_m_s2", "coupler_deflection_mm",
  "contact_force_n"];

/// Channels of a described linkage: journals first, then the others without poses, extremes and the time.
/** @param {string} jobId  @param {AbortSignal} signal */
async function findChannels(jobId, signal) {
  const kept = Object.keys(await findTrajectory(jobId, { from: 0, to: 0 }, signal))
    .filter((name) => name !== "t_s" && !/^pose_|_(min|max)_/.test(name));
  const journals = kept.filter((name) => /_journal_[xy]_mm$/.test(name));
  return [...journals, ...kept.filter((name) => !journals.includes(name))];
}

/**
 * @param {HTMLElement} element
 * @param {AnalysedSweep} analysed
 * @param {AbortSignal} signal
 */
export async function bifurcationCard(element, { sweep, numbers, isRpsup, jobId }, signal) {
  let along = numbers[0];
  const channels = isRpsup ? ofRpsup : await findChannels(jobId, signal);
  let channel = channels[0];
  let rows = [];
  const drawing = h("div", { class: "chart tall" });
  const trouble = h("p", { class: "trouble", role: "status" });
  const tell = (text) => { trouble.textContent = text; };
  const load = latest(async (current, /** @type {string} */ wanted) => {
    rows = await findAnalysis(sweep.id, "bifurcation", { channel: wanted }, current);
    channel = wanted;
    chart?.draw();
  }, signal);
  let chart = null;
  await load(channel);
  if (rows.length === 0) {
    element.replaceChildren(h("p", {}, "No revolution is complete after the run-up of these jobs."));
    return null;
  }
  element.replaceChildren(h("p", { class: "actions" },
    choice("x axis", numbers.map((axis) => [axis, titleOf(axis)]), along, (axis) => { along = axis; chart?.draw(); }),
    quantityChoice("Channel", "channels", channels, channel,
      (wanted) => retryWhileUnreachable(() => load(wanted), tell, signal).catch((error) => tell(error.message)))),
  trouble, drawing);
  chart = await makeChart(drawing, () => optionOf(rows, sweep.axes.filter((axis) => axis !== along), along, channel),
    "Bifurcation diagram: the channel once per revolution", signal);
  return chart;
}

function optionOf(rows, others, along, channel) {
  if (rows.length === 0) return null;
  const groups = Map.groupBy(rows, (row) => where(row, others));
  /** @type {[string, any[]][]} */
  const drawn = groups.size > mostNamed ? [[`${plural(groups.size, "combination")} of the other axes`, rows]] : [...groups];
  return {
    grid: { left: 75, right: 20, top: 40, bottom: 50 }, legend: { top: 0, show: groups.size > 1 },
    tooltip: { formatter: ({ value }) => `${pointOf(along, value[0])}\n${number(value[1])}` },
    xAxis: acrossAxis(titleOf(along)), yAxis: valueAxis(titleOf(channel)),
    series: drawn.map(([name, some], index) => ({ name, type: "scatter", symbolSize: 4, color: lineColour(index), large: true,
      data: some.filter((row) => row[channel] !== null).map((row) => [row[along], row[channel]]) })),
  };
}
