// SPDX-License-Identifier: Apache-2.0
// Lists in forms, such as the variables of a fit: items that are added and taken away, each with a place for
// its fault.
import { h } from "/core/dom.js";

/** @typedef {import("/form/request_form.js").RequestForm} RequestForm */

/// Text of a value in a form; empty if there is none.
/** @param {unknown} value */
export const textOf = (value) => (value === undefined ? "" : String(value));

/// A list with a heading. @param draw  elements of an item  @param noun  for an item
/**
 * @template Item
 * @param {RequestForm} form
 * @param {{ title: string, noun: string, items: Item[], fresh: () => Item, help?: string,
 *   draw: (item: Item, index: number) => HTMLElement[] }} list
 */
export function listFields(form, { title, noun, items, fresh, help, draw }) {
  const place = h("div");
  const redraw = () => place.replaceChildren(...items.map((item, index) =>
    h("div", { class: "item", role: "group", "aria-label": `${noun} ${index + 1}` }, draw(item, index),
      h("button", { type: "button", "aria-label": `Remove ${noun.toLowerCase()} ${index + 1}`,
        onclick: () => { items.splice(index, 1); redraw(); form.update(); } }, "✕"))));
  redraw();
  return h("section", {}, h("h2", {}, title), help ? h("p", { class: "quiet small" }, help) : null, place,
    h("p", { class: "actions" }, h("button", { type: "button",
      onclick: () => { items.push(fresh()); redraw(); form.update(); } }, `Add ${noun.toLowerCase()}`)));
}

/// Controls beside each other with a place for their fault, by the name of the row.
/** @param {RequestForm} form  @param {string} name  @param {(HTMLElement | null)[]} controls */
export function itemRow(form, name, controls) {
  const fault = h("p", { class: "trouble small", hidden: true });
  const inputs = controls.flatMap((control) => [...control?.querySelectorAll("input, select") ?? []]);
  form.rows.set(name, { complain: (text) => {
    fault.textContent = text;
    fault.hidden = text === "";
    for (const input of inputs) input.setAttribute("aria-invalid", text === "" ? "false" : "true");
  } });
  return [h("div", { class: "actions" }, controls), fault];
}

/// A labelled text of an item. @param attributes  of its input
/**
 * @param {RequestForm} form
 * @param {string} label
 * @param {any} item
 * @param {string} key
 * @param {Record<string, any>} attributes
 */
export function itemText(form, label, item, key, attributes = {}) {
  const input = h("input", { type: "text", value: item[key], size: 8, ...attributes,
    oninput: () => { item[key] = input.value; form.update(); } });
  return h("label", { class: "choice" }, h("span", {}, label), input);
}
