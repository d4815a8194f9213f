// SPDX-License-Identifier: Apache-2.0
// Numbers as people type them: decimal points and commas, lists, and units of entry.
import { number } from "/core/format.js";

/// Question on a number with three digits after its comma, which may part thousands; empty if there is none.
/** @param {string} text */
export function doubtOf(text) {
  const typed = text.trim();
  if (!/^[-−+]?[1-9]\d{0,2},\d{3}$/.test(typed)) return "";
  return `“${typed}” may be ${number(decimal(typed), 7)} or ${typed.replace(",", "")}: write one of these`;
}

/// A number with a point or a comma before its decimals.
/** @param {string} text */
function decimal(text) {
  const typed = text.trim().replaceAll("−", "-");
  if (typed === "") return NaN;
  return Number(/^[^.,]*,[^.,]*$/.test(typed) ? typed.replace(",", ".") : typed);
}

/// One number; NaN for anything else. A single comma is a decimal comma, if it cannot part thousands.
/** @param {string} text */
export function readNumber(text) {
  return doubtOf(text) ? NaN : decimal(text);
}

/// The number in a field, or the usual value where the field is empty; NaN for anything else.
/**
 * @template Usual
 * @param {string} text
 * @param {Usual} usual
 * @returns {number | Usual}
 */
export const numberOr = (text, usual) => (text.trim() === "" ? usual : readNumber(text));

/// Fault of a field that may have a number; empty if there is none.
/** @param {string} text */
export const faultOfNumber = (text) => (Number.isFinite(numberOr(text, 0)) ? "" : doubtOf(text) || "must be a number");

/// Numbers of a list. Commas before a space separate, as do semicolons and spaces; between digits they are
/// decimal, where semicolons separate, and separate, where numbers have decimal points or there are several.
/** @param {string} text  @returns {{ values: number[], fault: string }} */
export function readList(text) {
  const pieces = text.split(/[;\s]+|,(?=\s|$)/).filter((piece) => piece && piece !== ",");
  /** @type {number[]} */
  const values = [];
  for (const piece of pieces) {
    const inside = piece.split(",");
    if (inside.length === 2 && text.includes(";")) values.push(decimal(piece));
    else if (inside.length === 2 && !piece.includes(".") && /^[-−+]?\d+,\d+(e[-−+]?\d+)?$/i.test(piece)) {
      return { values: [],
        fault: `“${piece}” may be one number or two: write ${inside.join(".")}, or ${inside.join("; ")}` };
    } else values.push(...inside.map(readNumber));
  }
  return { values, fault: "" };
}

const turn = 2 * Math.PI;

/// Units in which a value may be entered, with the factor to the unit of the field.
const entryUnits = { "rad/s": [["rpm", turn / 60], ["°/s", turn / 360]], rad: [["°", turn / 360]] };

/// Units of a field: its own, and others in which it may be entered.
/** @param {{ unit: string }} field  @returns {string[]} */
export const unitsOf = ({ unit }) => [unit, ...(entryUnits[unit] ?? []).map(([name]) => name)];

/// Factor from a unit of entry to the unit of the field.
/** @param {{ unit: string }} field  @param {string} [unit]  @returns {number} */
export const factorOf = (field, unit) => (entryUnits[field.unit] ?? []).find(([name]) => name === unit)?.[1]
  ?? 1;

/// Numbers in a text, from one unit to another, in at most 12 digits; as it is, if it has none.
/// @param isList  whether there may be several
/** @param {string} text  @param {number} factor  @param {boolean} isList */
export function converted(text, factor, isList = false) {
  const one = isList ? NaN : readNumber(text);
  const { values, fault } = Number.isFinite(one) ? { values: [one], fault: "" } : readList(text);
  if (fault || values.length === 0 || values.some((value) => !Number.isFinite(value))) return text;
  return values.map((value) => String(Number((value * factor).toPrecision(12)))).join(", ");
}
