// SPDX-License-Identifier: Apache-2.0
// Charts of a sweep's page, which are made one after the other. Of many rows only those charts are drawn that are in
// sight, or nearly so.
import { h, painted } from "/core/dom.js";

const manyRows = 2000;
const nearby = "50% 0px";  // of the window's height, above and below it

/** @typedef {(element: HTMLElement, page: SweepPage, signal: AbortSignal) => Promise<Chart>} MakeChart */

export class SeenCharts {
  /** @type {(Chart | null)[]} */
  #charts = [];
  /** @type {Set<Element>} */
  #near = new Set();
  /** @type {Map<Element, () => void>} */
  #waiting = new Map();  // actions once an element is near
  /** @type {Set<number>} */
  #outdated = new Set();
  /** @type {Promise<void>} */
  #turn = Promise.resolve();

  /** @param {SweepPage} page  @param {[MakeChart, HTMLElement][]} places */
  constructor(page, places) {
    this.page = page;
    this.places = places;
    const observer = new IntersectionObserver((entries) => entries.forEach((entry) => this.#moved(entry)),
      { rootMargin: nearby });
    for (const [, element] of places) observer.observe(element);
    page.signal.addEventListener("abort", () => observer.disconnect());
  }

  /// Chart of a place; nothing as long as it is not made.
  /** @param {number} index */
  at(index) { return this.#charts[index]; }

  make() {
    this.places.forEach(([, element], index) => this.#whenNear(element, () => this.#next(() => this.#make(index))));
  }

  /// Draws the charts that are made, many rows one chart after the other: a click is answered before that.
  draw() {
    this.places.forEach(([, element], index) => {
      if (!this.#charts[index]) return;
      if (!this.#hasMany()) this.#charts[index]?.draw();
      else this.#whenNear(element, () => this.#drawInTurn(index));
    });
  }

  #hasMany() { return this.page.rows.length > manyRows; }

  /** @param {IntersectionObserverEntry} entry */
  #moved({ target, isIntersecting }) {
    if (!isIntersecting) {
      this.#near.delete(target);
      return;
    }
    this.#near.add(target);
    const wanted = this.#waiting.get(target);
    this.#waiting.delete(target);
    wanted?.();
  }

  /** @param {HTMLElement} element  @param {() => void} act */
  #whenNear(element, act) {
    if (!this.#hasMany() || this.#near.has(element)) act();
    else this.#waiting.set(element, act);
  }

  /// Acts once everything before it is done and on the screen.
  /** @param {() => unknown} act */
  #next(act) {
    this.#turn = this.#turn.then(async () => {
      await painted();
      if (!this.page.signal.aborted) await act();
    });
  }

  /** @param {number} index */
  #drawInTurn(index) {
    if (this.#outdated.has(index)) return;
    this.#outdated.add(index);
    this.#next(() => {
      this.#outdated.delete(index);
      this.#charts[index]?.draw();
    });
  }

  /** @param {number} index */
  async #make(index) {
    const [make, element] = this.places[index];
    try {
      this.#charts[index] = await make(element, this.page, this.page.signal);
    } catch (error) {
      this.#charts[index] = null;
      element.replaceChildren(h("p", { class: "trouble" }, error.message));
    }
  }
}
