// SPDX-License-Identifier: Apache-2.0
// One parameter in the form: a value, a list or a range; or words to choose among.
import { freshId, h } from "/core/dom.js";
import { nameOf } from "/core/format.js";
import { allowed } from "/form/fields.js";
import { converted, factorOf, unitsOf } from "/form/numbers.js";

/// @param entry    what stands in it; is changed as the user types
/// @param changed  is called after each change
export function fieldRow(field, entry, changed) {
  const id = freshId("field");
  const values = h("div", { class: "values" });
  const fault = h("p", { class: "trouble small", id: `${id}-fault`, hidden: true });
  const input = (key, label, attributes = {}) => {
    const element = h("input", { value: entry[key], "aria-describedby": `${id}-help ${id}-fault`, "aria-label": label,
      ...attributes,
      oninput: () => { entry[key] = element.value; changed(); } });
    return element;
  };
  const labelled = (text, element) => h("label", { class: "small" }, `${text} `, element);
  const name = nameOf(field.path);

  /// Unit of entry, where there are several; what stands in the field is converted.
  function unitChoice() {
    const units = unitsOf(field);
    if (units.length === 1 || field.kind === "numbers") return [];
    const select = h("select", { "aria-label": `${name}: unit`, onchange: () => {
      const factor = factorOf(field, entry.unit) / factorOf(field, select.value);
      entry.text = converted(entry.text, factor, entry.mode === "list");
      for (const key of ["from", "to"]) entry[key] = converted(entry[key], factor);
      entry.unit = select.value;
      drawValues();
      changed();
    } }, units.map((unit) => h("option", { value: unit }, unit)));
    select.value = entry.unit || field.unit;
    return [select];
  }

  function drawValues() {
    if (field.kind === "words") return values.replaceChildren(...field.schema.enum.map(wordBox));
    if (entry.mode !== "range") {
      const usual = converted(String(field.default ?? ""), 1 / factorOf(field, entry.unit));
      const hint = entry.mode === "list" ? "0, 0.1, 0.2" : factorOf(field, entry.unit) === 1
        ? String(field.default ?? "") : usual;
      return values.replaceChildren(
        input("text", name, { type: "text", id, inputmode: entry.mode === "one" ? "decimal" : null,
          placeholder: hint }), ...unitChoice());
    }
    const scale = h("select",
      { "aria-label": `${name}: spacing`, onchange: () => { entry.scale = scale.value; changed(); } },
      h("option", { value: "linear" }, "linear"), h("option", { value: "log" }, "logarithmic"));
    scale.value = entry.scale;
    return values.replaceChildren(labelled("from", input("from", `${name}: from`, { type: "text" })),
      labelled("to", input("to", `${name}: to`, { type: "text" })),
      labelled("count", input("count", `${name}: count`, { type: "number", min: 1 })), scale,
        ...unitChoice());
  }

  function wordBox(word) {
    const box = h("input", { type: "checkbox", onchange: () => {
      entry.chosen = field.schema.enum.filter((each) => (each === word ? box.checked : entry.chosen.includes(each)));
      changed();
    } });
    box.checked = entry.chosen.includes(word);
    return h("label", {}, box, ` ${word}`);
  }

  const modes = h("select",
    { "aria-label": `${name}: kind of value`, onchange: () => { entry.mode = modes.value; drawValues(); changed(); } },
    ["one", "list", "range"].map((mode) => h("option", { value: mode }, mode === "one" ? "one value" : mode)));
  modes.value = entry.mode;
  drawValues();
  const short = (value) => (typeof value === "number" ? Number(value.toPrecision(6)) : value);
  const unit = field.unit ? ` ${field.unit}` : "";
  const fallback = field.default === undefined ? ""
    : `; default ${[field.default].flat().map(short).join(", ")}${unit}`;
  const label = field.kind === "words" ? h("span", {}, name)
    : h("label", { for: id }, name, field.unit && unitsOf(field).length === 1 ? ` [${field.unit}]` : "");
  const element = h("div",
    { class: "field", role: field.kind === "words" ? "group" : null, "aria-label": field.kind === "words" ? name : null,
      "data-path": field.path }, label,
    field.kind === "words" || field.kind === "numbers" ? h("span") : modes, values,
    h("p", { class: "quiet small",
      id: `${id}-help` }, `${field.help}. ${allowed(field)}${fallback}${field.source ? ` (${field.source})` : ""}. `,
      h("code", {}, field.path)), fault);

  /// Shows what is wrong here; nothing, if the text is empty.
  function complain(text) {
    fault.textContent = text;
    fault.hidden = text === "";
    for (const each of values.querySelectorAll("input")) each.setAttribute("aria-invalid",
      text === "" ? "false" : "true");
  }

  return { element, complain };
}
