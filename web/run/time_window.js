// SPDX-License-Identifier: Apache-2.0
// The stretch of time that is looked at, and the instant pointed at: the same for all plots of a job.

export class TimeWindow extends EventTarget {
  /// @param end   of the run [s]
  /// @param least the shortest stretch that makes sense [s]
  /// @param start of the run [s]
  /** @param {number} end  @param {number} least  @param {number} start */
  constructor(end, least, start = 0) {
    super();
    this.start = start;
    this.end = end;
    this.least = least;
    this.from = start;
    this.to = end;
    this.instant = start;
  }

  get length() { return this.to - this.from; }

  get isWhole() { return this.from === this.start && this.to === this.end; }

  /// Looks at another stretch; one outside the run is moved into it.
  /** @param {number} from  @param {number} to */
  set(from, to) {
    const length = Math.min(Math.max(to - from, this.least), this.end - this.start);
    const start = Math.min(Math.max(from, this.start), this.end - length);
    if (!Number.isFinite(start) || (start === this.from && start + length === this.to)) return;
    this.from = start;
    this.to = start + length;
    this.instant = Math.min(Math.max(this.instant, this.from), this.to);
    this.dispatchEvent(new Event("change"));
  }

  reset() { this.set(this.start, this.end); }

  /// @param factor  below 1 looks closer  @param about  the instant that stays in its place
  zoom(factor, about = (this.from + this.to) / 2) {
    this.set(about - (about - this.from) * factor, about + (this.to - about) * factor);
  }

  pan(part) { this.set(this.from + part * this.length, this.to + part * this.length); }

  /** @param {number} instant */
  pointAt(instant) {
    this.instant = Math.min(Math.max(instant, this.start), this.end);
    this.dispatchEvent(new Event("instant"));
  }
}

const keys = {
  ArrowLeft: (times) => times.pan(-0.2), ArrowRight: (times) => times.pan(0.2), "+": (times) => times.zoom(0.5),
  "-": (times) => times.zoom(2), 0: (times) => times.reset(),
};

/// Makes keys move the window while an element has the focus: arrows, + and -, 0 for the whole run.
export function listenToKeys(element, times) {
  element.tabIndex = 0;
  element.addEventListener("keydown", (event) => {
    const act = keys[event.key];
    if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    act(times);
  });
}
