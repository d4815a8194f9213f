// SPDX-License-Identifier: Apache-2.0
// The spectrum of a channel of a job, and its Poincaré section: made when they are opened.
import { findMotion } from "/core/api.js";
import { makeChart, nothingYet, saveButtons } from "/core/charts.js";
import { choice, h } from "/core/dom.js";
import { number, titleOf } from "/core/format.js";
import { latest, retryWhileUnreachable } from "/core/live.js";
import { quantityChoice } from "/core/quantities.js";
import { colour, lineColour } from "/core/theme.js";
import { acrossAxis, valueAxis } from "/analysis/parts.js";
import { clearanceJoints, isDescribed, mainAcceleration, turningChannels } from "/run/described.js";

/** @typedef {NonNullable<Api.Query<"/v1/jobs/{id}/spectrum">["window"]>} Window */
/** @type {Record<Window, true>} */
const windows = { hann: true, flat_top: true, rectangular: true };

/// @param columns  channels that may be chosen
/** @param {Api.Job} job  @param {string[]} columns  @param {AbortSignal} signal */
export function motionCard(job, columns, signal) {
  const body = h("div");
  const open = () => {
    if (!details.open || body.hasChildNodes()) return;
    const joints = clearanceJoints(job, columns);
    const angles = isDescribed(job) ? turningChannels(columns) : ["crank_angle_rad"];
    const parts = [spectrum(job, columns, signal), joints.length > 0 && angles.length > 0
      ? section(job, joints, angles, signal) : null].filter(Boolean);
    body.replaceChildren(...parts.map(({ element }) => element));
    for (const part of parts) part.fill()
      .catch((error) => error.name !== "AbortError"
        && part.element.append(h("p", { class: "trouble" }, error.message)));
  };
  const details = h("details", { class: "card", ontoggle: open }, h("summary", {}, "Spectrum and Poincaré section"),
    body);
  return details;
}

/// Loads again while the service is away or busy, and tells why that takes so long or fails.
/** @param {() => Promise<void>} load  @param {HTMLElement} trouble  @param {AbortSignal} signal */
function retried(load, trouble, signal) {
  const tell = (text) => { trouble.textContent = text; };
  return retryWhileUnreachable(load, tell, signal).catch((error) => tell(error.message));
}

/** @param {Api.Job} job  @param {string[]} columns  @param {AbortSignal} signal */
function spectrum(job, columns, signal) {
  /** @type {{ channel: string, window: Window }} */
  const view = { channel: isDescribed(job) ? mainAcceleration(columns) : "slider_acceleration_m_s2", window: "hann" };
  let found = null;
  let chart = null;
  const drawing = h("div", { class: "chart" });
  const trouble = h("p", { class: "trouble", role: "status" });
  const load = latest(async (current) => {
    const asked = { ...view };
    const from = job.parameters.run_up_s < job.parameters.duration_s ? job.parameters.run_up_s : undefined;
    const { frequency_hz: frequencies, [asked.channel]: amplitudes } = await findMotion(job.id, "spectrum",
      { ...asked, from }, current);
    found = { channel: asked.channel, frequencies, amplitudes };
    chart?.draw();
  }, signal);
  const tryLoad = () => retried(load, trouble, signal);
  const set = (key) => (value) => { view[key] = value; tryLoad(); };
  const element = h("div", {},
    h("div", { class: "head" }, h("h3", {}, "Spectrum of the steady window"),
      saveButtons(() => chart, () => `${job.id} spectrum`)),
    h("p", { class: "actions" }, quantityChoice("Channel", "channels", columns, view.channel, set("channel")),
      choice("Window", Object.keys(windows), view.window, set("window"))), trouble, drawing);
  const option = () => !found ? nothingYet("", "No values.")
    : ({ grid: { left: 80, right: 20, top: 20, bottom: 50 },
      tooltip: { trigger: "axis", formatter: ([{ value }]) => `${number(value[0])} Hz\n${number(value[1])}` },
    dataZoom: [{ type: "inside" }], xAxis: acrossAxis("Frequency [Hz]",
      { max: "dataMax", axisLabel: { color: colour("text"), hideOverlap: true,
        formatter: (value) => number(value) } }),
    yAxis: valueAxis(`Amplitude: ${titleOf(found.channel)}`,
      { type: "log", nameGap: 60, axisLabel: { color: colour("text"), formatter: (value) => number(value, 2) } }),
    series: [{ type: "line", showSymbol: false, color: lineColour(0), lineStyle: { width: 1 },
      data: found.frequencies.map((frequency, k) => [frequency, found.amplitudes[k]])
        .filter(([, amplitude]) => amplitude > 0) }] });
  return { element, fill: async () =>
    { await tryLoad(); chart = await makeChart(drawing, option, "Amplitude spectrum", signal); } };
}

/// A journal once a turn; the dashed outline is the clearance.
/**
 * @param {Api.Job} job
 * @param {ReturnType<typeof clearanceJoints>} joints
 * @param {string[]} angles  channels that turn
 * @param {AbortSignal} signal
 */
function section(job, joints, angles, signal) {
  const view = { phase: 0, joint: joints[0], angle: angles[0] };
  let found = null;
  let chart = null;
  const channelsOf = ({ prefix }) => [`${prefix}journal_x_mm`, `${prefix}journal_y_mm`];
  const drawing = h("div", { class: "chart square" });
  const trouble = h("p", { class: "trouble", role: "status" });
  const load = latest(async (current) => {
    const [x, y] = channelsOf(view.joint);
    const answer = await findMotion(job.id, "poincare", { channels: `${x},${y}`, angle: view.angle,
      phase_rad: view.phase, from: job.parameters.run_up_s }, current);
    found = { x: answer[x], y: answer[y], t_s: answer.t_s };
    chart?.draw();
  }, signal);
  const tryLoad = () => retried(load, trouble, signal);
  const set = (key) => (value) => { view[key] = value; tryLoad(); };
  const label = isDescribed(job) ? "Angle [rad]" : "Crank angle [rad]";
  const slider = h("input", { type: "range", min: 0, max: 6.28, step: 0.01, value: 0, "aria-label": label,
    onchange: () => set("phase")(Number(slider.value)) });
  const choices = [
    joints.length > 1 && choice("Joint", joints.map(({ name }) => name), view.joint.name,
      (name) => set("joint")(joints.find((joint) => joint.name === name))),
    angles.length > 1 && quantityChoice("Angle of", "channels", angles, view.angle, set("angle")),
    h("label", { class: "choice" }, h("span", {}, label), slider)].filter(Boolean);
  const element = h("div", {}, h("div", { class: "head" }, h("h3", {}, "Poincaré section of the journal"),
    saveButtons(() => chart, () => `${job.id} section`)), h("p", { class: "actions" }, choices), trouble, drawing);
  // As much room beside the drawing as above and below it, and axes of one length: a circle is round.
  const half = () => 1.1 * Math.max(view.joint.clearance.x, view.joint.clearance.y,
    ...[...found.x, ...found.y].map(Math.abs));
  const ends = () => ({ min: -half(), max: half(),
    axisLabel: { color: colour("text"), hideOverlap: true, showMinLabel: false, showMaxLabel: false,
      formatter: (value) => number(value, 2) } });
  const option = () => !found ? nothingYet("", "No values.")
    : ({ grid: { left: 75, right: 20, top: 20, bottom: 75 },
      tooltip: { formatter: ({ value }) => `${number(value[0])}, ${number(value[1])} mm at ${number(value[2])} s` },
    xAxis: acrossAxis(titleOf(channelsOf(view.joint)[0]), ends()),
    yAxis: valueAxis(titleOf(channelsOf(view.joint)[1]), ends()),
    series: [{ type: "line", silent: true, showSymbol: false, color: colour("quiet"),
      lineStyle: { width: 1, type: "dashed" }, data: outline(view.joint.clearance) },
      { type: "scatter", symbolSize: 7, color: lineColour(0),
        data: found.t_s.map((t, k) => [found.x[k], found.y[k], t]) }] });
  return { element, fill: async () =>
    { await tryLoad(); chart = await makeChart(drawing, option,
      "Poincaré section: the journal's centre once per revolution", signal); } };
}

/// Closed line around the places that a journal can have.
/** @param {import("/run/described.js").Clearance} clearance */
function outline({ isRound, x, y }) {
  if (!isRound) return [[-x, -y], [x, -y], [x, y], [-x, y], [-x, -y]];
  return Array.from({ length: 73 }, (_, k) => [x * Math.cos((k * Math.PI) / 36), x * Math.sin((k * Math.PI) / 36)]);
}
