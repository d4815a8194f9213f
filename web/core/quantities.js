// SPDX-License-Identifier: Apache-2.0
// Definitions of metrics and channels. The OpenAPI document, which has them, is fetched once one is needed.
import { requestSchemas } from "/core/api.js";
import { choice, h } from "/core/dom.js";
import { titleOf } from "/core/format.js";

/** @typedef {"metrics" | "channels"} Kind */
/** @typedef {{ description: string, "x-unit": string, "x-symbol"?: string }} Quantity */
/** @typedef {{ properties?: Record<string, Quantity>, patternProperties?: Record<string, Quantity> }} Schema */

/** @type {Promise<Record<Kind, Schema[]>> | null} */
let schemas = null;

/// Schemas of metrics and channels: properties by name, and by pattern those of described linkages.
function loadSchemas() {
  schemas ??= requestSchemas(new AbortController().signal)
    .then(({ Metrics, Trajectory }) => ({ metrics: Metrics.anyOf, channels: [Trajectory.properties.columns] }))
    .catch((error) => {
      schemas = null;
      throw error;
    });
  return schemas;
}

/// The schema of a quantity: that of its name, or of the most specific pattern that its name matches.
/** @param {Schema[]} all  @param {string} name  @returns {Quantity | undefined} */
function find(all, name) {
  const known = all.map(({ properties = {} }) => properties[name]).find(Boolean);
  const literals = (pattern) => pattern.replaceAll(".+", "").length;
  const patterns = all.flatMap(({ patternProperties = {} }) => Object.entries(patternProperties))
    .filter(([pattern]) => new RegExp(pattern).test(name)).sort(([a], [b]) => literals(b) - literals(a));
  return known ?? patterns[0]?.[1];
}

/// Definition of a metric or channel with its symbol and unit; empty if there is none of that name.
/** @param {Kind} kind  @param {string} name */
export async function definitionOf(kind, name) {
  const quantity = find((await loadSchemas())[kind], name);
  if (!quantity) return "";
  const { description, "x-symbol": symbol, "x-unit": unit } = quantity;
  return `${symbol ? `${symbol}: ` : ""}${description} [${unit}]`;
}

/// Attributes of an element that shows a definition when it is pointed at or has the focus.
/** @param {Kind} kind  @param {string} name */
export const defines = (kind, name) => ({ "data-kind": kind, "data-quantity": name });

/// A name whose definition is shown when it is pointed at, touched or reached with the keyboard.
/** @param {Kind} kind  @param {string} name  @param {string} text */
export const term = (kind, name, text) => h("span", { class: "term", tabindex: 0, ...defines(kind, name) }, text);

/// Select of metrics or channels that shows the definition of the chosen one.
/**
 * @param {string} label
 * @param {Kind} kind
 * @param {string[]} names
 * @param {string} value
 * @param {(chosen: string) => unknown} onchange
 */
export function quantityChoice(label, kind, names, value, onchange) {
  const element = choice(label, names.map((name) => [name, titleOf(name)]), value, (chosen) => {
    element.dataset.quantity = chosen;
    onchange(chosen);
  });
  Object.assign(element.dataset, { kind, quantity: value });
  return element;
}
