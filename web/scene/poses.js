// SPDX-License-Identifier: Apache-2.0
// Poses of the links and values of channels at an instant, fetched in chunks of time whose resolution suits the speed
// of playing.
import { findTrajectory } from "/core/api.js";

const framesPerStretch = 120;
const leastSamples = 400;
const mostNumbers = 4e6;  // in memory: 32 MB
const againMs = 2000;  // until a stretch that failed is asked for again
const parts = ["x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"];

export class Poses {
  /** @type {Map<string, { columns: Api.Columns | null }>} */
  #stretches = new Map();

  /// @param drawn   links by their names as in the channels: "1_1", "1_3_0"; and other channels
  /// @param loaded  is called when more is known than before, or may be asked for again
  /**
   * @param {Api.Job} job
   * @param {{ links: string[], others: string[] }} drawn
   * @param {(error: Error | null) => void} loaded
   * @param {AbortSignal} signal
   */
  constructor(job, { links, others }, loaded, signal) {
    this.job = job;
    this.links = links;
    this.others = others;
    this.loaded = loaded;
    this.signal = signal;
    this.channels = [...links.flatMap((link) => parts.map((part) => `pose_${link}_${part}`)), ...others];
  }

  /// Seconds of the run in one stretch, when two seconds of playing are to be in it.
  #lengthAt(speed) {
    const { duration_s: end, output_rate_hz: rate } = this.job.parameters;
    return Math.min(end, Math.max(2 * speed, leastSamples / rate));
  }

  /// The frames at an instant, as {link: [x, y, z, qx, qy, qz, qw]}, and the values of the other channels by their
  /// names; null until they have come. What follows next is fetched ahead.
  at(instant, speed) {
    const length = this.#lengthAt(speed);
    const last = Math.max(0, Math.ceil(this.job.parameters.duration_s / length) - 1);
    const index = Math.min(last, Math.floor(instant / length));
    if (index < last) this.#stretch(index + 1, length);
    const stretch = this.#stretch(index, length);
    return stretch.columns ? this.#between(stretch.columns, instant) : null;
  }

  #stretch(index, length) {
    const key = `${length}:${index}`;
    const known = this.#stretches.get(key) ?? { columns: null };
    if (!this.#stretches.has(key)) this.#load(known, index * length, (index + 1) * length, key);
    this.#stretches.delete(key);
    this.#stretches.set(key, known);  // the newest used stands last
    return known;
  }

  /// Forgets the stretches used longest ago, where all have too many numbers. That of the instant and the next one stay.
  #forget() {
    let numbers = 0;
    [...this.#stretches].reverse().forEach(([key, { columns }], age) => {
      numbers += columns ? columns.t_s.length * this.channels.length : 0;
      if (age > 1 && numbers > mostNumbers) this.#stretches.delete(key);
    });
  }

  async #load(stretch, from, to, key) {
    const points = framesPerStretch * 2 * this.channels.length;
    const { duration_s: end, output_rate_hz: rate } = this.job.parameters;
    try {
      // A sample more on either side: between two stretches there is no gap.
      const range = { from: Math.max(0, from - 1 / rate), to: Math.min(end, to + 1 / rate) };
      stretch.columns = await findTrajectory(this.job.id, { channels: ["t_s", ...this.channels], ...range, points },
        this.signal);
      this.#forget();
      this.loaded(null);
    } catch (error) {
      if (error.name === "AbortError") return;
      this.loaded(error);
      // Until then the stretch stays known, as empty: each drawing asks for all that are unknown.
      setTimeout(() => {
        this.#stretches.delete(key);
        if (!this.signal.aborted) this.loaded(null);
      }, againMs);
    }
  }

  /** @param {Api.Columns} columns  @param {number} instant */
  #between(columns, instant) {
    const times = columns.t_s;
    const right = Math.min(Math.max(1, firstAfter(times, instant)), times.length - 1);
    const left = Math.max(0, right - 1);
    const step = times[right] - times[left];
    const part = step > 0 ? Math.min(Math.max((instant - times[left]) / step, 0), 1) : 0;
    const frames = Object.fromEntries(this.links.map((link) => {
      const pose = (row) => parts.map((name) => columns[`pose_${link}_${name}`][row]);
      return [link, mix(pose(left), pose(right), part)];
    }));
    const values = Object.fromEntries(this.others.map((name) =>
      [name, columns[name][left] + part * (columns[name][right] - columns[name][left])]));
    return { frames, values };
  }
}

/// The number of times up to the instant.
function firstAfter(times, instant) {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= instant) low = middle + 1;
    else high = middle;
  }
  return low;
}

/// Between two poses; the quaternions by the shorter way, brought back to length one.
function mix(a, b, part) {
  const dot = a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6];
  const mixed = a.map((value, i) => value + part * ((i > 2 && dot < 0 ? -b[i] : b[i]) - value));
  const length = Math.hypot(...mixed.slice(3));
  return mixed.map((value, i) => (i > 2 ? value / length : value));
}

/// The links of a run by the names of its channels, in their order.
/** @param {string[]} channels */
export function linksOf(channels) {
  return channels.filter((name) => name.startsWith("pose_") && name.endsWith("_qw"))
    .map((name) => name.slice("pose_".length, -"_qw".length)).sort();
}
