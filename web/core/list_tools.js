// SPDX-License-Identifier: Apache-2.0
// Order of lists, items that are marked to be deleted together, and questions about the rows in sight.
import { isTransient } from "/core/api.js";
import { confirmed } from "/core/dialog.js";
import { choice, h, isNear, notify } from "/core/dom.js";
import { debounce, inTurn } from "/core/live.js";

const settleMs = 200;  // after scrolling

/** @typedef {{ id: string, name: string }} Named */

/// Order of a list, chosen in a select that phones have, too, or by a click on a heading.
/** @template Item */
export class ListOrder {
  /** @type {Map<string, HTMLElement>} */
  #headings = new Map();

  /// @param keys  of the order, with the heading and the value of an item  @param chosen  "name", or
  /// "-created" for the
  /// largest first  @param changed  is called when another order has been chosen
  /**
   * @param {Record<string, [string, (item: Item) => string | number]>} keys
   * @param {string | null} chosen
   * @param {(chosen: string) => void} changed
   */
  constructor(keys, chosen, changed) {
    this.keys = keys;
    this.changed = changed;
    this.usual = "-created";
    this.chosen = chosen && chosen.replace("-", "") in keys ? chosen : this.usual;
    const options = Object.entries(keys).flatMap(([key, [text]]) =>
      (key === "created" ? [["-created", "newest first"], ["created", "oldest first"]]
        : [[key, `${text}, up`], [`-${key}`, `${text}, down`]]));
    this.element = choice("Sort by", options, this.chosen, (order) => this.set(order));
  }

  get isUsual() { return this.chosen === this.usual; }

  /** @param {string} order */
  set(order) {
    this.chosen = order;
    /** @type {HTMLSelectElement | null} */
    const select = this.element.querySelector("select");
    if (select) select.value = order;
    this.draw();
    this.changed(this.isUsual ? "" : order);
  }

  /// Content of a heading: a button that orders by it, up and then down.
  /** @param {string} key  @param {string} text */
  heading(key, text) {
    if (!(key in this.keys)) return text;
    const button = h("button", { onclick: () => this.set(this.chosen === key ? `-${key}` : key) }, text);
    this.#headings.set(key, button);
    this.draw();
    return button;
  }

  draw() {
    for (const [key, button] of this.#headings) {
      const isChosen = this.chosen.replace("-", "") === key;
      button.textContent = this.keys[key][0] + (isChosen ? (this.chosen.startsWith("-") ? " ▼" : " ▲") : "");
      if (isChosen) button.closest("th")?.setAttribute("aria-sort", this.chosen.startsWith("-")
        ? "descending" : "ascending");
      else button.closest("th")?.removeAttribute("aria-sort");
    }
  }

  /** @param {Item[]} items */
  ordered(items) {
    const valueOf = this.keys[this.chosen.replace("-", "")][1];
    const sign = this.chosen.startsWith("-") ? -1 : 1;
    const compare = (a, b) => (typeof a === "number" ? a - b : String(a).localeCompare(String(b), "en",
      { numeric: true }));
    return [...items].sort((a, b) => sign * compare(valueOf(a), valueOf(b)));
  }
}

/// Items that are marked, and the bar that deletes them.
/** @template {Named} Item */
export class Marked {
  /** @type {Set<string>} */
  #ids = new Set();
  /** @type {Item[]} */
  #items = [];
  bar = h("p", { class: "actions card", hidden: true });

  /// @param nouns   for one item and for several
  /// @param mayGo   whether an item can be deleted
  /// @param remove  deletes one
  /// @param done    is called after that
  /// @param also    what else goes, as a sentence after a space
  /**
   * @param {{ nouns: string[], mayGo: (item: Item) => boolean, remove: (id: string) => Promise<unknown>,
   *   done: () => unknown, also?: string }} how
   */
  constructor({ nouns, mayGo, remove, done, also = " Results that no others share are deleted, too." }) {
    this.also = also;
    this.nouns = nouns;
    this.mayGo = mayGo;
    this.remove = remove;
    this.done = done;
    this.all = h("input", { type: "checkbox", "aria-label": `Select all ${nouns[1]}`, onchange: () => {
      this.#ids = new Set(this.all.checked ? this.#items.map(({ id }) => id) : []);
      this.draw();
    } });
  }

  /** @param {number} count */
  count(count) { return `${count.toLocaleString("en")} ${this.nouns[count === 1 ? 0 : 1]}`; }

  /// Box of an item. Its label is that of the item at that time.
  /** @param {Named} item */
  box({ id, name }) {
    const box = h("input", { type: "checkbox", "data-id": id, "aria-label": `Select ${name || id}`,
      onchange: () => {
      if (box.checked) this.#ids.add(id);
      else this.#ids.delete(id);
      this.draw();
    } });
    box.checked = this.#ids.has(id);
    return box;
  }

  /// Takes the items that are listed now. What is not listed any more is not marked either.
  /** @param {Item[]} items */
  update(items) {
    this.#items = items;
    this.#ids = new Set(items.map(({ id }) => id).filter((id) => this.#ids.has(id)));
    this.draw();
  }

  draw() {
    const marked = this.#items.filter(({ id }) => this.#ids.has(id));
    const staying = marked.filter((item) => !this.mayGo(item)).length;
    this.all.checked = marked.length > 0 && marked.length === this.#items.length;
    this.all.indeterminate = marked.length > 0 && !this.all.checked;
    for (const box of /** @type {NodeListOf<HTMLInputElement>} */ (document.querySelectorAll("input[data-id]"))) {
      box.checked = this.#ids.has(box.dataset.id ?? "");
    }
    this.bar.hidden = marked.length === 0;
    if (marked.length === 0) return;
    this.bar.replaceChildren(h("span", {}, `${this.count(marked.length)} selected`),
      h("button", { class: "danger", disabled: staying === marked.length, onclick: () => this.#removeAll() },
        "Delete selected"),
      h("button", { onclick: () => { this.#ids.clear(); this.draw(); } }, "Clear selection"),
      staying > 0 ? h("span", { class: "quiet small" },
        `${staying === marked.length ? "None can be deleted" : `${this.count(staying)} cannot be deleted`}: under way, or part of a study.`)
          : "");
  }

  async #removeAll() {
    const going = this.#items.filter((item) => this.#ids.has(item.id) && this.mayGo(item));
    const names = going.slice(0, 3).map(({ id, name }) => `“${name || id}”`).join(", ");
    const more = going.length > 3 ? ` and ${going.length - 3} more` : "";
    if (!(await confirmed(`Delete ${this.count(going.length)}: ${names}${more}?${this.also}`,
      "Delete"))) return;
    for (const { id } of going) {
      try {
        await this.remove(id);
        this.#ids.delete(id);
      } catch (error) {
        notify(error.message, "trouble");
      }
    }
    this.done();
  }
}

/// A function that asks about the rows in sight, or nearly so, one after the other. It is called after scrolling, too.
/// @param ask  of a row, which does nothing where all is known. While the service is away or busy, the questions end until the next call.
/**
 * @template {{ element: HTMLElement }} Row
 * @param {() => Iterable<Row>} rows
 * @param {(row: Row) => Promise<void>} ask
 * @param {AbortSignal} signal
 */
export function askInSight(rows, ask, signal) {
  const run = inTurn(async () => {
    for (const row of [...rows()].filter(({ element }) => isNear(element))) {
      try {
        await ask(row);
      } catch (error) {
        if (error.name === "AbortError" || isTransient(error)) return;
      }
    }
  });
  addEventListener("scroll", debounce(run, settleMs), { signal });
  return run;
}
