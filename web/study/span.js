// SPDX-License-Identifier: Apache-2.0
// Range of an axis: so wide that rounding does not look like an effect, logarithmic for values decades apart.

const leastSpan = 1e-3;  // of the largest value: what differs by less is drawn as nearly equal
const decades = 100;

/// The ends of an axis for values that differ by too little to be told apart; null where the values' own will do.
/** @param {Extremes} extremes  @returns {Extremes | null} */
export function widened({ min, max }) {
  const least = leastSpan * Math.max(Math.abs(min), Math.abs(max));
  // Equal values have an axis of their own: there is no difference to be magnified.
  if (!(max > min && max - min < least)) return null;
  const power = 10 ** Math.floor(Math.log10(least / 2));
  const step = least <= 4 * power ? 2 * power : 10 * power;  // round ends for the axis' labels
  const middle = (min + max) / 2;
  return { min: Math.floor((middle - least / 2) / step) * step, max: Math.ceil((middle + least / 2) / step) * step };
}

/// An axis of values that is as wide as they are, and never too narrow.
export const fittedAxis = { type: "value", scale: true, min: (extremes) => widened(extremes)?.min ?? null,
  max: (extremes) => widened(extremes)?.max ?? null };

/// The least and the largest of some numbers.
/** @param {Iterable<number>} values  @returns {Extremes} */
export function extremesOf(values) {
  let [min, max] = [Infinity, -Infinity];
  for (const value of values) {
    min = Math.min(min, value);
    max = Math.max(max, value);
  }
  return { min, max };
}

/// True for positive numbers that span two decades or more.
/** @param {any[]} values */
export function spansDecades(values) {
  if (values.some((value) => typeof value !== "number")) return false;
  const { min, max } = extremesOf(values);
  return min > 0 && max >= decades * min && Number.isFinite(max);
}
