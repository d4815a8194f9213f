// SPDX-License-Identifier: Apache-2.0
// Filters of a table as they are typed below its headings: "> 5", "0.1 .. 0.3", "flex".
import { doubtOf, readNumber } from "/form/numbers.js";
import { valueOf } from "/study/data.js";

/** @typedef {(row: Api.Row) => boolean} Passes */

const number = String.raw`[+\-−]?(?:\d+[.,]?\d*|[.,]\d+)(?:e[+\-−]?\d+)?`;
const range = new RegExp(`^(${number})\\s*(?:\\.\\.|…| to )\\s*(${number})$`, "i");
const comparison = new RegExp(`^(<=|>=|≤|≥|<|>|=)?\\s*(${number})$`, "i");

/// @throws an Error where a comma may part thousands
/** @param {string} text */
function numberOf(text) {
  const doubt = doubtOf(text);
  if (doubt) throw new Error(doubt);
  return readNumber(text);
}

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
  const ends = range.exec(wanted)?.slice(1).map(numberOf);
  if (ends) return (row) => typeof row[column] === "number" && row[column] >= ends[0] && row[column] <= ends[1];
  const [, sign = "=", typed] = comparison.exec(wanted) ?? [];
  if (typed === undefined) throw new Error(`“${wanted}” is no filter of numbers: write 5, > 5, ≤ 5 or 5 .. 10`);
  const bound = numberOf(typed);
  return (row) => typeof row[column] === "number" && holds[sign](row[column], bound);
}
