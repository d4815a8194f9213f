// SPDX-License-Identifier: Apache-2.0
// JSON text that people edit: what fits into a line stands in one.

const width = 56;

/// @param indent  spaces before the text
/** @param {any} value  @returns {string} */
export function jsonText(value, indent = 0) {
  const line = oneLine(value);
  if (line.length + indent <= width || typeof value !== "object" || value === null) return line;
  const inner = " ".repeat(indent + 1);
  const textOf = (each) => jsonText(each, indent + 1);
  const members = Array.isArray(value) ? value.map((each) => `${inner}${textOf(each)}`)
    : Object.entries(value).map(([key, each]) => `${inner}${JSON.stringify(key)}: ${textOf(each)}`);
  const [open, close] = Array.isArray(value) ? "[]" : "{}";
  return `${open}\n${members.join(",\n")}\n${" ".repeat(indent)}${close}`;
}

/** @param {any} value  @returns {string} */
function oneLine(value) {
  if (Array.isArray(value)) return `[${value.map(oneLine).join(", ")}]`;
  if (typeof value !== "object" || value === null) return JSON.stringify(value);
  const members = Object.entries(value).map(([key, each]) => `${JSON.stringify(key)}: ${oneLine(each)}`);
  return `{${members.join(", ")}}`;
}
