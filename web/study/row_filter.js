// SPDX-License-Identifier: Apache-2.0
// Filters of a table as they are typed below its headings: "> 5", "0.1 .. 0.3", "flex".
import { valueOf } from "/study/data.js";

/** @typedef {(row: Api.Row) => boolean} Passes */

const number = String.raw`[+\-−]?(?:\d+[.,]?\d*|[.,]\d+)(?:e[+\-−]?\d+)?`;
const range = new RegExp(`^(${number})\\s*(?:\\.\\.|…| to )\\s*(${number})$`, "i");
const comparison = new RegExp(`^(<=|>=|≤|≥|<|>|=)?\\s*(${number})$`, "i");

/** @param {string} text */
const numberOf = (text) => Number(text.replace(",", ".").replaceAll("−", "-"));

/** @type {Record<string, (value: number, bound: number) => boolean>} */
const holds = { "<": (value, bound) => value < bound, ">": (value, bound) => value > bound,
  "<=": (value, bound) => value <= bound, ">=": (value, bound) => value >= bound,
    "≤": (value, bound) => value <= bound,
  "≥": (value, bound) => value >= bound,
  // The table shows four digits.
  "=": (value, bound) => value === bound || Math.abs(value - bound) < 5e-5 * Math.abs(bound) };

/// The test of a filter; null for an empty one. @param isNumeric  whether the column has numbers
/// @throws an Error that says how a filter is written
/** @param {string} column  @param {string} text  @param {boolean} isNumeric  @returns {Passes | null} */
export function filterOf(column, text, isNumeric) {
  const wanted = text.trim();
  if (wanted === "") return null;
  if (!isNumeric) return (row) => String(valueOf(row, column)).toLowerCase().includes(wanted.toLowerCase());
  const [, from, to] = range.exec(wanted) ?? [];
  if (from !== undefined) return (row) => typeof row[column] === "number" && row[column] >= numberOf(from)
    && row[column] <= numberOf(to);
  const [, sign = "=", bound] = comparison.exec(wanted) ?? [];
  if (bound === undefined) throw new Error(`“${wanted}” is no filter of numbers: write 5, > 5, ≤ 5 or 5 .. 10`);
  return (row) => typeof row[column] === "number" && holds[sign](row[column], numberOf(bound));
}
