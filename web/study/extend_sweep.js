// SPDX-License-Identifier: Apache-2.0
// Dialog that adds values to the axes of a sweep.
import { extendSweep } from "/core/api.js";
import { formDialog } from "/core/dialog.js";
import { h } from "/core/dom.js";
import { titleOf } from "/core/format.js";
import { readList } from "/form/numbers.js";

/// Axes to which values can be added: lists and ranges of the request.
/** @type {(sweep: Api.Sweep) => string[]} */
export const extendableAxes = ({ request }) => Object.keys(request.sweep ?? {});

/// Values of a field: numbers, or words where the axis has no numbers.
/** @param {string} text  @param {any} axis  @param {string} name */
function valuesOf(text, axis, name) {
  if (text.trim() === "") return [];
  if (Array.isArray(axis) && typeof axis[0] !== "number") return text.split(/[;,\s]+/).filter(Boolean);
  const { values, fault } = readList(text);
  if (fault || values.some((value) => !Number.isFinite(value)))
    throw new Error(`${titleOf(name)}: ${fault || "must be numbers"}`);
  return values;
}

/// Resolves to the sweep with its new jobs; to null if nothing is added.
/** @param {Api.Sweep} sweep  @returns {Promise<Api.Sweep | null>} */
export function extendDialog(sweep) {
  const axes = /** @type {Record<string, any>} */ (sweep.request.sweep ?? {});
  const fields = Object.fromEntries(Object.keys(axes)
    .map((name) => [name, h("input", { type: "text", class: "wide" })]));
  const content = Object.entries(fields).map(([name, field]) =>
    h("p", {}, h("label", { class: "choice wide" }, h("span", {}, titleOf(name)), field)));
  return formDialog("More values for the axes",
    [...content, h("p", { class: "quiet small" }, "Only jobs with new values are computed.")], "Extend",
    async () => {
      const added = Object.fromEntries(Object.entries(fields)
        .map(([name, field]) => [name, valuesOf(field.value, axes[name], name)])
        .filter(([, values]) => values.length > 0));
      if (Object.keys(added).length === 0) throw new Error("Write a value into a field.");
      return extendSweep(sweep.id, { sweep: added });
    });
}
