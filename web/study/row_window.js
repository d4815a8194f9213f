// SPDX-License-Identifier: Apache-2.0
// Cells of a table that are drawn: those that are seen and some around them, with room for all the others.
import { h } from "/core/dom.js";

const around = 8;  // rows above and below what is seen
const fewRows = 100;  // so few are drawn all at once, with all their columns
const columnsAround = 3;  // columns on both sides of what is seen
const restMs = 100;  // without a jump until the rows around are drawn, too

/** @typedef {(row: any, place: number, from: number, to: number) => HTMLTableRowElement} MakeRow */

export class RowWindow {
  /** @type {any[]} */
  rows = [];
  /** @type {Map<any, HTMLTableRowElement>} */
  #drawn = new Map();
  /** @type {number[]} */
  #ends = [];
  #first = -1;
  #columns = "";
  #frame = 0;
  /** @type {number | undefined} */
  #rest;

  /// @param scroll     element that scrolls
  /// @param rowHeight  of each row, in pixels
  /// @param before     width of the columns that every row has, in pixels
  /// @param make       makes the element of a row, with the cells of the columns from "from" up to "to"
  /**
   * @param {HTMLElement} scroll
   * @param {HTMLTableSectionElement} body
   * @param {{ rowHeight: number, before: number, make: MakeRow }} how
   */
  constructor(scroll, body, { rowHeight, before, make }) {
    this.scroll = scroll;
    this.body = body;
    this.rowHeight = rowHeight;
    this.before = before;
    this.make = make;
    scroll.addEventListener("scroll", () => {
      if (this.#frame === 0) this.#frame = requestAnimationFrame(() => { this.#frame = 0; this.#follow(); });
    }, { passive: true });
    new ResizeObserver(() => this.#follow()).observe(scroll);
  }

  /// Shows other rows, or the same ones anew. @param widths  of the columns, in pixels
  /** @param {any[]} rows  @param {number[]} widths */
  show(rows, widths) {
    this.rows = rows;
    let end = this.before;
    this.#ends = widths.map((width) => (end += width));
    this.#columns = "";  // of no row that is drawn
    this.#follow();
  }

  #clear() {
    this.#drawn.clear();
    this.body.replaceChildren();
    this.#first = -1;
  }

  /// Places of the first row that is drawn and of the one after the last.
  #range() {
    const { length } = this.rows;
    if (length <= fewRows) return [0, length];
    const seen = Math.ceil((this.scroll.clientHeight || 600) / this.rowHeight);
    // The place scrolled to may be behind the last row, if there are fewer rows than before.
    const top = Math.min(Math.floor(this.scroll.scrollTop / this.rowHeight), Math.max(0, length - seen));
    // In steps of half of what stands around: most frames of a scroll draw nothing.
    const first = Math.max(0, Math.floor((top - around) / (around / 2)) * (around / 2));
    const end = Math.min(length, first + seen + 2.5 * around);
    const isJump = this.#first >= 0 && (first >= this.#first + this.#drawn.size || end <= this.#first);
    if (!isJump) return [first, end];
    // The next jump, as of a dragged scroll bar, would throw away what stands around.
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => this.#follow(), restMs);
    return [top, Math.min(length, top + seen + 1)];
  }

  /// Places of the first column that is drawn and of the one after the last.
  #columnRange() {
    const { length } = this.#ends;
    if (this.rows.length <= fewRows) return [0, length];
    const left = this.scroll.scrollLeft;
    const right = left + (this.scroll.clientWidth || 1300);
    const first = this.#ends.findIndex((end) => end > left);
    const last = this.#ends.findIndex((end) => end >= right);
    const even = (place) => Math.floor(place / columnsAround) * columnsAround;
    return [Math.max(0, even(first - columnsAround)),
      last < 0 ? length : Math.min(length, even(last) + 2 * columnsAround)];
  }

  #follow() {
    const [first, end] = this.#range();
    const [from, to] = this.#columnRange();
    const columns = `${from} ${to}`;
    // Only now: had the table been laid out without its rows, it would have been scrolled to its top.
    if (columns !== this.#columns) this.#clear();
    if (first === this.#first && this.#drawn.size === end - first) return;
    this.#first = first;
    this.#columns = columns;
    const wanted = new Map(this.rows.slice(first, end).map((row, k) => [row, first + k]));
    const kept = this.#drawn;
    // Rows that stay are left where they are: put in anew, all their cells would be laid out again.
    for (const [row, element] of kept) if (!wanted.has(row)) element.remove();
    for (const room of this.body.querySelectorAll(".room")) room.remove();
    const drawn = new Map([...wanted].map(([row, place]) => [row, kept.get(row) ?? this.make(row, place, from, to)]));
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
