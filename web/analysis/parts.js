// SPDX-License-Identifier: Apache-2.0
// Common parts of the charts and tables of analyses.
import { axisLook } from "/core/charts.js";
import { h } from "/core/dom.js";
import { number, pointOf, titleOf } from "/core/format.js";

/// The values of some axes in a row, in words: "rigid, 10 rad/s".
export const where = (row, axes) => axes.filter((axis) => row[axis] !== undefined && row[axis] !== null)
  .map((axis) => pointOf(axis, row[axis])).join(", ");

export const valueAxis = (title, more = {}) =>
  ({ type: "value", scale: true, name: title, nameLocation: "middle", nameGap: 50, ...axisLook(), ...more });
export const acrossAxis = (title, more = {}) =>
  ({ type: "value", scale: true, name: title, nameLocation: "middle", nameGap: 28, ...axisLook(), ...more });

/// Upright bars from the second to the third number of each datum, at the first.
export function bars(color, data, width = 2) {
  return { type: "custom", color, data, silent: true, encode: { x: 0, y: [1, 2] }, renderItem: (_, api) => {
    const [x, low] = api.coord([api.value(0), api.value(1)]);
    const [, high] = api.coord([api.value(0), api.value(2)]);
    return { type: "line", shape: { x1: x, y1: low, x2: x, y2: high },
      style: { stroke: api.visual("color"), lineWidth: width, opacity: 0.6 } };
  } };
}

/// A table of rows. @param columns  [heading, text of a row, class of its cells if they have one] each  @param look
/// class of the table
/**
 * @param {string} label
 * @param {any[]} rows
 * @param {any[]} columns
 * @param {string | null} look
 */
export function table(label, rows, columns, look = null) {
  return h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": label },
    h("table", { class: look },
      h("thead", {}, h("tr", {}, columns.map(([heading, , cell]) => h("th", { scope: "col", class: cell }, heading)))),
      h("tbody", {}, rows.map((row) =>
        h("tr", {}, columns.map(([, text, cell]) => h("td", { class: cell }, text(row))))))));
}

export const axisColumns = (axes) =>
  axes.map((axis) => [titleOf(axis), (row) => number(row[axis], 6)]);
