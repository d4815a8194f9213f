// SPDX-License-Identifier: Apache-2.0
// Choice of the columns of a table.
import { h } from "/core/dom.js";
import { defines } from "/core/quantities.js";

/// @param all  gives the names of all columns  @param changed  is called when the choice has changed
/** @param {{ all: () => string[], titleOf: (column: string) => string, changed: () => void }} given */
export function columnChoice({ all, titleOf, changed }) {
  /** @type {Set<string>} */
  const hidden = new Set();
  const summary = h("summary");
  const list = h("div", { class: "list" });
  const set = (columns) => { hidden.clear(); for (const column of columns) hidden.add(column); changed(); };
  const element = h("details", { class: "menu left" }, summary, h("div", { class: "card" },
    h("p", { class: "actions" }, h("button", { onclick: () => set([]) }, "All"),
      h("button", { onclick: () => set(all().slice(1)) }, "None")), list));
  let drawn = "";

  const shown = () => all().filter((column) => !hidden.has(column));

  function draw() {
    const columns = all();
    summary.textContent = `Columns: ${shown().length} of ${columns.length}`;
    for (const box of list.querySelectorAll("input")) box.checked = !hidden.has(box.value);
    if (JSON.stringify(columns) === drawn) return;
    drawn = JSON.stringify(columns);
    list.replaceChildren(...columns.map((column) => {
      const box = h("input", { type: "checkbox", value: column,
        onchange: () => { if (box.checked) hidden.delete(column); else hidden.add(column); changed(); } });
      box.checked = !hidden.has(column);
      return h("label", defines("metrics", column), box, ` ${titleOf(column)}`);
    }));
  }

  return { element, shown, draw };
}
