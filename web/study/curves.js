// SPDX-License-Identifier: Apache-2.0
// Curves of a metric over an axis: the look of each, and which of them are drawn at once.
import { paletteColour, lineColour } from "/core/theme.js";
import { pointOf } from "/core/format.js";
import { groupBy, hasScale, none, valuesOf } from "/study/data.js";
import { extremesOf, spansDecades } from "/study/span.js";

export const mostCurves = 12;  // at once: more cannot be told apart
const patterns = ["solid", "dashed", "dotted", [10, 3, 2, 3], [2, 2, 8, 2], [14, 4]];
const symbols = ["circle", "rect", "triangle", "diamond", "roundRect", "arrow"];

/** @typedef {{ key: string, values: (string | number)[], groups: Group[], sweep: string }} Curve */

/// Axes of the curves: that of their colours, a scale if one of them has one, and that of their line styles.
/** @param {Pick<SweepPage, "rows" | "view">} sweep */
export function rolesOf({ rows, view }) {
  const keys = [...new Set([view.y, view.panel])].filter((key) => key && key !== view.x);
  const colour = keys.find((key) => hasScale(rows, key)) ?? keys[0] ?? "";
  return { colour, style: keys.find((key) => key !== colour) ?? "",
    isScale: colour !== "" && hasScale(rows, colour) };
}

/// Curves with a value at least; where jobs have none, a group without a mean stands in its place.
/// @param name  of the sweep, where it is not the one that is looked at
/**
 * @param {Api.Row[]} rows
 * @param {SweepPage["view"]} view
 * @param {ReturnType<typeof rolesOf>} roles
 * @param {string} name
 */
export function curvesOf(rows, view, { colour, style }, name = "") {
  const keys = [colour, style].filter(Boolean);
  /** @type {Map<string, Curve>} */
  const curves = new Map();
  for (const group of groupBy(rows, [...keys, view.x], view.metric)) {
    const values = group.values.slice(0, -1);
    const key = JSON.stringify(values);
    const curve = curves.get(key) ?? { key, values, groups: [], sweep: name };
    curves.set(key, curve);
    curve.groups.push(group);
  }
  const order = new Map(valuesOf(rows, view.x).map((value, place) => [value, place]));
  const place = (group) => order.get(group.values.at(-1)) ?? 0;
  const ranks = keys.map((key) => new Map(valuesOf(rows, key).map((value, rank) => [value, rank])));
  const rankOf = (curve, rank, i) => rank.get(curve.values[i]) ?? 0;
  const compare = (a, b) => ranks.map((rank, i) => rankOf(a, rank, i) - rankOf(b, rank, i))
    .find((difference) => difference !== 0) ?? 0;
  for (const curve of curves.values()) curve.groups.sort((a, b) => place(a) - place(b));
  return [...curves.values()].filter(({ groups }) => groups.some((group) => group.count > 0)).sort(compare);
}

/// "0.25 mm, rigid": what a curve is of.
/** @param {Curve} curve  @param {ReturnType<typeof rolesOf>} roles */
export function nameOfCurve({ values, sweep }, { colour, style }) {
  const keys = [colour, style].filter(Boolean);
  return [...keys.map((key, i) => (values[i] === none ? "" : pointOf(key, values[i]))),
    sweep].filter(Boolean).join(", ");
}

/// A selection of places, evenly spread, with the one that must be among them.
/** @param {number} count  @param {number} most  @param {number} must */
function spread(count, most, must) {
  if (count <= most) return Array.from({ length: count }, (_, place) => place);
  if (most === 1) return [must];
  const places = Array.from({ length: most }, (_, k) => Math.round((k * (count - 1)) / (most - 1)));
  const distance = (k) => Math.abs(places[k] - must);
  const nearest = places.reduce((best, _, k) => (distance(k) < distance(best) ? k : best), 0);
  places[nearest] = must;
  return places;
}

/** @param {Curve} curve */
const largestOf = ({ groups }) => Math.max(...groups.map(({ max }) => max));

/// Evenly spread curves, with the one of the largest value: all styles of a colour together, if there are
/// few.
/** @param {Curve[]} curves  @param {number} most */
function spreadCurves(curves, most) {
  if (curves.length <= most) return curves;
  const peak = curves.reduce((best, curve) => (largestOf(curve) > largestOf(best) ? curve : best));
  const colours = [...new Set(curves.map(({ values }) => values[0]))];
  const bundles = colours.map((value) => curves.filter(({ values }) => values[0] === value));
  const size = Math.max(...bundles.map(({ length }) => length));
  if (2 * size > most) return spread(curves.length, most, curves.indexOf(peak)).map((place) => curves[place]);
  return spread(bundles.length, Math.floor(most / size),
    colours.indexOf(peak.values[0])).flatMap((place) => bundles[place]);
}

/// The curves that are drawn. @param chosen  keys of those that the user wants; null for evenly spread ones
/** @param {Curve[]} curves  @param {string[] | null} chosen  @param {number} most */
export function drawnCurves(curves, chosen, most = mostCurves) {
  const wanted = chosen ? curves.filter(({ key }) => chosen.includes(key)) : [];
  return wanted.length > 0 ? wanted.slice(0, most) : spreadCurves(curves, most);
}

/// Place of a number on the scale of an axis, 0 to 1: logarithmic where values lie decades apart.
/** @param {number[]} values  @returns {(value: number) => number} */
export function scaleOf(values) {
  const { min, max } = extremesOf(values);
  const isLog = spansDecades(values);
  const at = (value) => (isLog ? Math.log(value) : value);
  return (value) => (max > min ? (at(value) - at(min)) / (at(max) - at(min)) : 0.5);
}

/// Colour, line style and mark of each curve.
/** @param {Api.Row[]} rows  @param {ReturnType<typeof rolesOf>} roles */
export function looksOf(rows, { colour, style, isScale }) {
  const numbers = isScale ? valuesOf(rows, colour).filter((value) => typeof value === "number") : [];
  const scale = scaleOf(numbers);
  const ranks = [colour, style].map((key) => (key ? valuesOf(rows, key) : []))
    .map((values) => new Map(values.map((value, rank) => [value, rank])));
  return ({ values }) => {
    const rank = (style ? ranks[1].get(values[1]) : isScale ? 0 : ranks[0].get(values[0])) ?? 0;
    const [value] = values;
    return { colour: isScale && typeof value === "number" ? paletteColour(scale(value))
      : lineColour(ranks[0].get(value) ?? 0),
      pattern: patterns[rank % patterns.length], symbol: symbols[rank % symbols.length] };
  };
}

