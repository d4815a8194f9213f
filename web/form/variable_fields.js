// SPDX-License-Identifier: Apache-2.0
// Variables of fits and optimisations: the parameters that are looked for, each between two bounds.
import { choice, freshId, h } from "/core/dom.js";
import { itemRow, itemText, listFields, textOf } from "/form/list_fields.js";
import { addNumber } from "/form/study_form.js";
import { titleOfVariable } from "/study/variables.js";

/** @typedef {{ path: string, from: string, to: string, start: string, scale: string }} VariableEntry */

/// Contents of the form for the variables of a request.
/** @param {Record<string, Api.Schemas["Variable"]>} over  @returns {VariableEntry[]} */
export const readVariables = (over = {}) => Object.entries(over).map(([path, { from, to, start, scale }]) =>
  ({ path, from: textOf(from), to: textOf(to), start: textOf(start), scale: scale ?? "linear" }));

/// @param names  of parameters that are offered; others may be written
/**
 * @param {import("/form/request_form.js").RequestForm} form
 * @param {VariableEntry[]} items
 * @param {string[]} names
 * @param {string} help
 */
export function variableFields(form, items, names, help) {
  const list = h("datalist", { id: freshId("variables") },
    names.map((name) => h("option", { value: name }, titleOfVariable(name))));
  const draw = (item, index) => itemRow(form, `over.${index}`, [
    itemText(form, "Parameter", item, "path", { list: list.id, size: 34 }),
      itemText(form, "From", item, "from"),
    itemText(form, "To", item, "to"), itemText(form, "Start (optional)", item, "start"),
    choice("Spacing", [["linear", "linear"], ["log", "logarithmic"]], item.scale,
      (scale) => { item.scale = scale; form.update(); })]);
  const fresh = () => ({ path: "", from: "", to: "", start: "", scale: "linear" });
  return [listFields(form, { title: "Variables", noun: "Variable", items, fresh, help, draw }), list];
}

/// Puts the variables into a request.
/**
 * @param {VariableEntry[]} items
 * @param {any} request
 * @param {{ path: string, detail: string }[]} problems
 */
export function addVariables(items, request, problems) {
  request.over = {};
  items.forEach(({ path, scale, ...numbers }, index) => {
    const name = path.trim();
    if (name === "") return problems.push({ path: `over.${index}`, detail: "has no parameter" });
    if (name in request.over) return problems.push({ path: `over.${index}`, detail: "is given twice" });
    const variable = {};
    for (const key of ["from", "to", "start"]) {
      addNumber(numbers[key], key, `over.${index}`, variable, problems);
    }
    if (scale !== "linear") variable.scale = scale;
    request.over[name] = variable;
    return undefined;
  });
}

/// Row of the variable that a pointer such as "/over/clearance_mm/to" means; empty if it is none.
/** @param {string} pointer  @param {VariableEntry[]} items */
export function rowOfVariable(pointer, items) {
  const [, part, path] = pointer.split("/").map((each) => each.replaceAll("~1", "/").replaceAll("~0", "~"));
  const index = part === "over" ? items.findIndex((item) => item.path.trim() === path) : -1;
  return index < 0 ? "" : `over.${index}`;
}
