// SPDX-License-Identifier: Apache-2.0
// One job, or several laid over each other: what the slider and the journal did, and why.
import { cancelJob, findJob, findSweep, findTrajectory, parameterSchema, trajectoryUrl } from "/core/api.js";
import { choice, h, notify, part } from "/core/dom.js";
import { nameOfChannel, number, titleOfChannel } from "/core/format.js";
import { pause, retryWhileUnreachable, throttle } from "/core/live.js";
import { readRoute, rememberQuery, routeTo } from "/core/route.js";
import { colour } from "/core/theme.js";
import { clearanceJoints, driveChannels, isDescribed, mainAcceleration, settingOf,
  titleOfLinkage } from "/run/described.js";
import { withEnvelope, withoutEnds } from "/run/envelopes.js";
import { lossesCard, metricsCard, runCard } from "/run/facts.js";
import { idealOf, isIdeal } from "/run/ideal.js";
import { motionCard } from "/analysis/motion.js";
import { wearCard } from "/analysis/wear.js";
import { orbit } from "/run/orbit.js";
import { findOverlays, readOverlays, writeOverlays } from "/run/measured.js";
import { measurementPicker } from "/run/measurement_picker.js";
import { overlayPicker } from "/run/overlay.js";
import { peakNote } from "/run/peaks.js";
import { plotCard, tracesOf } from "/run/plot_card.js";
import { standingCard } from "/run/standing.js";
import { timeBar } from "/run/time_bar.js";
import { TimeWindow } from "/run/time_window.js";
import { sceneCard } from "/scene/scene_card.js";

/** @typedef {NonNullable<Api.Query<"/v1/jobs/{id}/trajectory">["format"]>} Format */
/** @type {Record<Format, true>} */
const isFormat = { csv: true, json: true, npz: true };
const formats = /** @type {Format[]} */ (Object.keys(isFormat));
/** @type {(state: Api.State) => boolean} */
const isWaiting = (state) => state === "queued" || state === "running";
/// Jobs with a trajectory, which plots need: they have succeeded and store it.
/** @type {(job: Api.Job) => boolean} */
const hasTrajectory = ({ state, parameters: { keep } }) => state === "succeeded" && keep !== "metrics";
const sliderAcceleration = "slider_acceleration_m_s2";
const energies = ["kinetic_energy_j", "potential_energy_j", "drive_work_j"];
/// Parameters in the titles of RPSUP's jobs.
const inTitles = ["coupler", "crank", "rod", "cross", "clearance_mm", "crank_velocity_rad_s"];
const pollMs = 1000;
const sweepPolls = 5;  // its sweep is asked for with every fifth
const rememberMs = 400;  // browsers refuse to change the address many times a second

/// "Drive torque", "Drive force", or both.
/** @param {string[]} channels */
function titleOfDrives(channels) {
  const torques = channels.filter((name) => name.endsWith("_n_m")).length;
  return torques === 0 ? "Drive force" : torques === channels.length ? "Drive torque" : "Drive torque and force";
}

/// Job that is laid over another; null if there is no such job any more.
/** @param {string} id  @param {AbortSignal} signal  @returns {Promise<Api.Job | null>} */
async function findOther(id, signal) {
  try {
    return await findJob(id, signal);
  } catch (error) {
    if (error.status === 404) return null;
    throw error;
  }
}

/** @param {HTMLElement} main  @param {Visit} view */
export async function show(main, { id, query, signal }) {
  const others = (query.get("with") ?? "").split(",").filter(Boolean);
  const [schema, job, ...found] = await Promise.all([parameterSchema(), findJob(id, signal),
    ...others.map((other) => findOther(other, signal))]);
  /** @type {(other: Api.Job) => boolean} */
  const isComparable = hasTrajectory(job) ? hasTrajectory : ({ state }) => state === "succeeded";
  const more = found.filter((other) => other !== null).filter(isComparable);
  document.title = `RPSUP: job ${id.slice(-5)}`;
  // The varied parameters of a sweep tell its jobs apart. A sweep may be gone.
  const sweep = job.sweep_id ? await findSweep(job.sweep_id, signal).catch(() => null) : null;
  signal.throwIfAborted();
  const page = new JobPage([job, ...more], schema, query, signal, sweep?.axes ?? []);
  page.omitted = others.filter((other) => !more.some((each) => each.id === other));
  if (job.state !== "succeeded") {
    await page.waitForEnd(main);
    return;
  }
  main.replaceChildren(...page.head());
  main.append(...(hasTrajectory(job) ? await page.body() : page.metricsAlone()));
}

class JobPage {
  state = h("span");
  main = h("div");
  extra = h("div");
  /** @type {Pick<Trace, "channel" | "envelope">} */
  acceleration = { channel: sliderAcceleration };
  /// Channels of the run, without the poses.
  /** @type {string[]} */
  columns = [];
  /** @type {AbortController | undefined} */
  mainLife;
  /// Curves of measurements, each in the plot of its channel.
  /** @type {Trace[]} */
  measured = [];
  /// Ids of jobs that the address lays over this one and that cannot be.
  /** @type {string[]} */
  omitted = [];

  /**
   * @param {Api.Job[]} jobs
   * @param {any} schema
   * @param {URLSearchParams} query
   * @param {AbortSignal} signal
   * @param {string[]} axes  of its sweep
   */
  constructor(jobs, schema, query, signal, axes) {
    this.axes = axes;
    this.jobs = jobs;
    this.job = jobs[0];
    this.schema = schema;
    this.query = query;
    this.signal = signal;
    const { duration_s: end, output_rate_hz: rate } = this.job.parameters;
    this.times = new TimeWindow(end, Math.min(end, 5 / rate));
    this.added = (query.get("channels") ?? "").split(",").filter(Boolean);
    this.overlays = readOverlays(query.get("measured") ?? "");
  }

  head() {
    const { job } = this;
    const { clearance_mm: clearance, coupler, crank_velocity_rad_s: velocity, linkage } = job.parameters;
    /** @type {any} */
    const drive = job.parameters.crank_drive;
    const bent = ["crank", "rod", "cross"].filter((link) => job.parameters[link] === "flexible")
      .map((link) => `flexible ${link}, `).join("");
    const what = typeof linkage === "object" ? titleOfLinkage(linkage)
      : `${coupler} coupler, ${bent}clearance ${number(clearance, 6)} mm, ${velocity === undefined
        ? `crank by ${drive?.law ?? drive?.actuator}` : `${number(velocity, 6)} rad/s`}`;
    const others = this.axes.filter((axis) => typeof linkage === "object" || !inTitles.includes(axis));
    const title = [what, settingOf(job, others)].filter(Boolean).join(", ");
    const back = job.sweep_id ? h("a", { href: routeTo("sweeps", job.sweep_id) }, "sweep") : "no sweep";
    this.drawState();
    const failure = job.error ? h("p", { class: "trouble" }, `${job.error.reason}: ${job.error.detail}`) : null;
    const links = hasTrajectory(job)
      ? h("p", { class: "actions" },
        formats.map((format) =>
          h("a", { class: "button", href: trajectoryUrl(job.id, { format }), download: `${job.id}.${format}` },
            format.toUpperCase())))
      : h("p", { class: "actions" },
        isWaiting(job.state)
          ? h("button", { onclick: () => cancelJob(job.id).catch((error) => notify(error.message, "trouble")) },
            "Cancel") : null);
    return [h("div", { class: "head" }, h("div", {}, h("h1", {}, title),
      h("p", { class: "quiet" }, `Job ${job.id}, `, this.state, " · ", back, this.overlaid())), links),
      failure].filter(Boolean);
  }

  /// Overlaid jobs and measurements, and jobs that cannot be overlaid.
  overlaid() {
    const ends = this.omitted.map((id) => `…${id.slice(-5)}`).join(", ");
    return [this.jobs.length > 1 ? ` · overlaid with ${this.jobs.length - 1} more` : "",
      ends ? ` · without ${ends}: deleted, not succeeded or without trajectory` : "",
      this.jobs.length > 1 || ends
        ? [" · ", h("a", { href: routeTo("jobs", this.job.id) }, "this job only")] : "",
      this.overlays.length > 0 ? [" · measured signals laid over · ",
        h("a", { href: this.addressWith([]) }, "without them")] : ""].flat();
  }

  drawState() {
    this.state.className = this.job.state;
    this.state.textContent = this.job.state;
  }

  /// Shows how the job stands until it has ended, and then what came of it.
  async waitForEnd(main) {
    const trouble = h("p", { class: "trouble", role: "status" });
    const tell = (text) => { trouble.textContent = text; };
    const standing = standingCard();
    const redraw = () => main.replaceChildren(...this.head(), trouble,
      h("div", { class: "columns even" }, standing.element, runCard(this.job, this.schema, this.axes)));
    redraw();
    let sweep = await this.findItsSweep(tell);
    standing.draw(this.job, sweep, new Date());
    for (let { state } = this.job, polls = 1; isWaiting(state); ({ state } = this.job), polls += 1) {
      await pause(pollMs, this.signal);
      this.job = await retryWhileUnreachable(() => findJob(this.job.id, this.signal), tell, this.signal);
      if (this.job.state === "succeeded") return dispatchEvent(new Event("hashchange"));
      if (isWaiting(this.job.state)) this.drawState();
      else redraw();
      standing.draw(this.job, sweep, new Date());
      if (this.job.state === state && polls % sweepPolls !== 0) continue;
      sweep = await this.findItsSweep(tell);
      standing.draw(this.job, sweep, new Date());
    }
    return undefined;
  }

  findItsSweep(tell) {
    const { sweep_id: id } = this.job;
    return id ? retryWhileUnreachable(() => findSweep(id, this.signal), tell, this.signal) : null;
  }

  /// Page of a job that stores no trajectory.
  metricsAlone() {
    return [h("p", { class: "quiet" }, "No plots: this job keeps its metrics alone."),
      h("div", { class: "columns even" }, metricsCard(this.jobs, this.axes),
        runCard(this.job, this.schema, this.axes))];
  }

  async body() {
    const [from, to] = ["from", "to"].map((key) => Number(this.query.get(key) ?? NaN));
    if (Number.isFinite(from + to)) this.times.set(from, to);
    if (this.query.has("t")) this.times.pointAt(Number(this.query.get("t")) || 0);
    const remember = throttle(() => this.signal.aborted || this.remember(), rememberMs);
    for (const event of ["change", "instant"]) this.times.addEventListener(event, remember, { signal: this.signal });
    const [first, measured] = await Promise.all([findTrajectory(this.job.id, { from: 0, to: 0 }, this.signal),
      findOverlays(this.overlays, this.jobs.length, this.signal)]);
    const all = Object.keys(first);
    this.measured = measured;
    // The poses are for drawing.
    const columns = all.filter((name) => name !== "t_s" && !name.startsWith("pose_"));
    this.columns = columns;
    const described = isDescribed(this.job);
    this.acceleration = withEnvelope(described ? mainAcceleration(columns) : sliderAcceleration, columns);
    const joints = clearanceJoints(this.job, columns);
    const drives = described ? driveChannels(columns) : ["crank_torque_n_m", "rod_force_n"];
    const inCards = [this.acceleration.channel, ...joints.map(({ prefix }) => `${prefix}contact_force_n`),
      ...drives,
      ...energies];
    this.added.push(...new Set(measured.map(({ channel }) => channel)
      .filter((channel) => columns.includes(channel) && !inCards.includes(channel)
        && !this.added.includes(channel))));
    this.drawAcceleration([]);
    for (const channel of this.added) this.extra.append(this.channelCard(channel));
    const offered = withoutEnds(columns);
    const add = choice("Add channel", [["", "choose …"], ...offered.map((name) => [name, titleOfChannel(name)])], "",
      (channel) => this.add(channel, add));
    const plots = [this.main,
      joints.length > 0 ? this.card("Contact force", joints.map(({ prefix }) => `${prefix}contact_force_n`)) : null,
      drives.length > 0 ? this.card(titleOfDrives(drives), drives) : null,
      this.energy(), this.extra, h("p", { class: "card actions" }, add, this.overlay(),
        this.measurements(columns)),
      motionCard(this.job, offered, this.signal),
      wearCard(this.job, joints.filter(({ prefix }) => all.includes(`${prefix}ring_1_sliding_work_j`)), this.signal)];
    const side = [sceneCard(this.job, all, this.times, this.signal),
      ...joints.map((joint) => orbit(this.job, joint, this.times, this.signal)),
      metricsCard(this.jobs, this.axes), runCard(this.job, this.schema, this.axes)];
    return [timeBar(this.times, this.job, this.acceleration, this.signal),
      h("div", { class: "columns" }, h("div", {}, plots.filter(Boolean)), h("div", {}, side.filter(Boolean)))];
  }

  /**
   * @param {string} title
   * @param {string[]} channels
   * @param {Partial<Parameters<typeof plotCard>[1]>} more
   */
  card(title, channels, more = {}) {
    const traces = tracesOf(this.jobs, channels.map((channel) => withEnvelope(channel, this.columns)), this.axes, title);
    return plotCard(title, { traces: [...traces, ...this.measuredOf(channels)],
      note: peakNote(this.jobs, channels, this.axes),
      times: this.times, height: 220, signal: this.signal, ...more });
  }

  /** @param {Api.Job[]} ideal */
  drawAcceleration(ideal) {
    const { acceleration } = this;
    const behind = ideal.map((job) =>
      ({ job: job.id, channel: acceleration.channel, name: "ideal linkage", colour: () => colour("quiet"),
        dash: [6, 4] }));
    const button = h("button", { onclick: () => this.compare(button) }, "Overlay ideal linkage");
    const tools = isDescribed(this.job) || isIdeal(this.job) || ideal.length > 0 ? [] : [button];
    this.mainLife?.abort();
    this.mainLife = new AbortController();
    const signal = AbortSignal.any([this.signal, this.mainLife.signal]);
    this.main.replaceChildren(plotCard(nameOfChannel(acceleration.channel),
      { traces: [...behind, ...tracesOf(this.jobs, [acceleration], this.axes),
        ...this.measuredOf([acceleration.channel])],
        note: peakNote(this.jobs, [acceleration.channel], this.axes),
        times: this.times, height: 320, signal, tools }));
  }

  async compare(button) {
    button.disabled = true;
    try {
      this.drawAcceleration([await idealOf(this.job, this.signal)]);
    } catch (error) {
      button.disabled = false;
      if (error.name !== "AbortError") notify(error.message, "trouble");
    }
  }

  /** @param {string[]} channels */
  measuredOf(channels) {
    return this.measured.filter(({ channel }) => channels.includes(channel));
  }

  /// Address of this page with other measured signals.
  /** @param {import("/run/measured.js").Overlay[]} overlays */
  addressWith(overlays) {
    const { query } = readRoute();
    query.set("measured", writeOverlays(overlays));
    return routeTo("jobs", this.job.id, Object.fromEntries(query));
  }

  /// Filled when the measurements are known. @param columns  of the job
  /** @param {string[]} columns */
  measurements(columns) {
    const place = h("span", { class: "actions" });
    measurementPicker(columns,
      (overlay) => { location.hash = this.addressWith([...this.overlays, overlay]); },
      this.signal).then((picker) => place.append(...picker)).catch(() => {});
    return place;
  }

  /// Filled when the other jobs of the sweep are known.
  overlay() {
    const place = h("span");
    overlayPicker(this.jobs, (id) => {
      const { query } = readRoute();
      query.set("with", [...this.jobs.slice(1).map((job) => job.id), id].join(","));
      location.hash = routeTo("jobs", this.job.id, Object.fromEntries(query));
    }, this.signal).then((picker) => picker && place.append(picker)).catch(() => {});
    return place;
  }

  energy() {
    const card = this.card("Energy balance", energies);
    card.append(lossesCard(this.job));
    return card;
  }

  add(channel, picker) {
    part("select", picker).value = "";
    if (!channel || this.added.includes(channel)) return;
    this.added.push(channel);
    this.extra.append(this.channelCard(channel));
    this.remember();
  }

  channelCard(channel) {
    const life = new AbortController();
    const card = this.card(titleOfChannel(channel), [channel],
      { signal: AbortSignal.any([this.signal, life.signal]), close: () => {
      life.abort();
      card.remove();
      this.added = this.added.filter((name) => name !== channel);
      this.remember();
    } });
    return card;
  }

  remember() {
    const { times } = this;
    const short = (value) => Number(value.toPrecision(7));
    const window = times.isWhole ? {} : { from: short(times.from), to: short(times.to) };
    rememberQuery({ with: this.query.get("with"), measured: writeOverlays(this.overlays),
      channels: this.added.join(","), ...window,
      t: times.instant > 0 ? short(times.instant) : "" });
  }
}
