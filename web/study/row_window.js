// SPDX-License-Identifier: Apache-2.0
// Rows of a table that are drawn: those that are seen and some around them, with room for all the others.
import { h } from "/core/dom.js";

const around = 12;  // rows above and below what is seen
const fewRows = 100;  // which are drawn all at once

export class RowWindow {
  /** @type {any[]} */
  rows = [];
  /** @type {Map<any, HTMLTableRowElement>} */
  #drawn = new Map();
  #first = -1;
  #frame = 0;

  /// @param scroll     element that scrolls
  /// @param rowHeight  of each row, in pixels
  /// @param make       makes the element of a row
  /**
   * @param {HTMLElement} scroll
   * @param {HTMLTableSectionElement} body
   * @param {number} rowHeight
   * @param {(row: any, place: number) => HTMLTableRowElement} make
   */
  constructor(scroll, body, rowHeight, make) {
    this.scroll = scroll;
    this.body = body;
    this.rowHeight = rowHeight;
    this.make = make;
    scroll.addEventListener("scroll", () => {
      if (this.#frame === 0) this.#frame = requestAnimationFrame(() => { this.#frame = 0; this.#follow(); });
    }, { passive: true });
    new ResizeObserver(() => this.#follow()).observe(scroll);
  }

  /// Shows other rows, or the same ones anew.
  /** @param {any[]} rows */
  show(rows) {
    this.rows = rows;
    this.#drawn.clear();
    this.body.replaceChildren();
    this.#first = -1;
    this.#follow();
  }

  /// Places of the first row that is drawn and of the one after the last.
  #range() {
    const { length } = this.rows;
    if (length <= fewRows) return [0, length];
    const seen = Math.ceil((this.scroll.clientHeight || 600) / this.rowHeight);
    const top = Math.floor(this.scroll.scrollTop / this.rowHeight);
    // In steps of half of what stands around: most frames of a scroll draw nothing.
    const first = Math.max(0, Math.floor((top - around) / (around / 2)) * (around / 2));
    return [first, Math.min(length, first + seen + 2.5 * around)];
  }

  #follow() {
    const [first, end] = this.#range();
    if (first === this.#first && this.#drawn.size === end - first) return;
    this.#first = first;
    const wanted = new Map(this.rows.slice(first, end).map((row, k) => [row, first + k]));
    const kept = this.#drawn;
    // Rows that stay are left where they are: put in anew, all their cells would be laid out again.
    for (const [row, element] of kept) if (!wanted.has(row)) element.remove();
    for (const room of this.body.querySelectorAll(".room")) room.remove();
    const drawn = new Map([...wanted].map(([row, place]) => [row, kept.get(row) ?? this.make(row, place)]));
    let next = null;
    for (const element of [...drawn.values()].reverse()) {
      if (element.nextSibling !== next || element.parentNode === null) this.body.insertBefore(element, next);
      next = element;
    }
    this.#drawn = drawn;
    this.body.prepend(...this.#room(first));
    this.body.append(...this.#room(this.rows.length - end));
  }

  /// A row as high as those that are not drawn.
  /** @param {number} count */
  #room(count) {
    if (count <= 0) return [];
    const cell = h("td");
    cell.style.height = `${count * this.rowHeight}px`;
    return [h("tr", { class: "room", "aria-hidden": "true" }, cell)];
  }
}
