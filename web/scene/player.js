// SPDX-License-Identifier: Apache-2.0
// Player: advances the instant at a fraction of real time, slower during impacts.

const slowdown = 50;
const around = 0.006;  // seconds of the run on either side of an impact
const longestFrame = 0.1;

export class Player extends EventTarget {
  speed = 0.1;
  playing = false;
  slow = true;
  /** @type {number[]} */
  impacts = [];

  /** @param {TimeWindow} times  @param {AbortSignal} signal */
  constructor(times, signal) {
    super();
    this.times = times;
    signal.addEventListener("abort", () => { this.playing = false; });
  }

  /// Seconds of the run in a second of the clock, at this instant.
  speedAt(instant, step) {
    const near = this.slow && this.impacts.some((impact) => impact > instant - around && impact < instant + step
      + around);
    return near ? this.speed / slowdown : this.speed;
  }

  toggle() {
    this.playing = !this.playing;
    this.dispatchEvent(new Event("change"));
    if (!this.playing) return;
    let last = performance.now();
    const tick = (now) => {
      if (!this.playing) return;
      // The first frame may have begun before the button was pressed.
      this.advance(Math.min(Math.max(now - last, 0) / 1000, longestFrame));
      last = now;
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  /// @param elapsed  seconds of the clock
  advance(elapsed) {
    const { from, to, instant } = this.times;
    const start = instant < from || instant >= to ? from : instant;
    const next = start + elapsed * this.speedAt(start, elapsed * this.speed);
    this.times.pointAt(Math.min(next, to));
  }
}

/// The instants of the hard impacts of a run: where the acceleration spreads inside one sample more than this part
/// of its widest spread.
/** @param {Api.Columns} columns */
export function impactsOf({ t_s: times, slider_acceleration_min_m_s2: least, slider_acceleration_max_m_s2: largest },
  part = 0.25) {
  const spread = times.map((_, i) => largest[i] - least[i]);
  const widest = spread.reduce((most, value) => Math.max(most, value), 0);
  return times.filter((_, i) => widest > 0 && spread[i] >= part * widest && spread[i] >= (spread[i - 1] ?? 0)
    && spread[i] >= (spread[i + 1] ?? 0));
}
