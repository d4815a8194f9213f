// SPDX-License-Identifier: Apache-2.0
// The jobs that are selected: one set for all parts of a sweep's page.

export class Selection extends EventTarget {
  /** @type {Set<string>} */
  #ids = new Set();

  get size() { return this.#ids.size; }

  get ids() { return [...this.#ids]; }

  /** @param {string} id */
  has(id) { return this.#ids.has(id); }

  /** @param {string[]} ids */
  set(ids) {
    const next = new Set(ids);
    if (next.size === this.#ids.size && [...next].every((id) => this.#ids.has(id))) return;
    this.#ids = next;
    this.dispatchEvent(new Event("change"));
  }

  /// Takes jobs in, or out if all of them are in.
  /** @param {string[]} ids */
  toggle(ids) {
    const given = new Set(ids);
    const all = ids.every((id) => this.#ids.has(id));
    this.set(all ? this.ids.filter((id) => !given.has(id)) : [...this.#ids, ...ids]);
  }
}
