// SPDX-License-Identifier: Apache-2.0
// A value with its intervals, drawn between the bounds of the parameter.
import { h } from "/core/dom.js";
import { number } from "/core/format.js";

/** @typedef {{ low: number | null, high: number | null }} Interval */

/// An interval in words: "0.21 to 0.2104"; an end that the signals do not give is open.
/** @param {Interval | null} interval  @param {number} digits */
export function intervalText(interval, digits = 4) {
  if (!interval || (interval.low === null && interval.high === null)) return "–";
  if (interval.low === null) return `up to ${number(interval.high, digits)}`;
  if (interval.high === null) return `from ${number(interval.low, digits)}`;
  return `${number(interval.low, digits)} to ${number(interval.high, digits)}`;
}

/// The broad bar is the interval by the profile, or the range; the thin one the linearised interval; the tick
/// the value.
/**
 * @param {Api.Schemas["FittedParameter"]} parameter
 * @param {boolean} isLog
 */
export function intervalBar({ value, linearised, profile, range, from, to }, isLog) {
  const scaled = (x) => (isLog ? Math.log(x) : x);
  const placeOf = (x) => Math.min(Math.max((scaled(x) - scaled(from)) / (scaled(to) - scaled(from)), 0), 1);
  const bar = h("div", { class: "interval", role: "img",
    "aria-label": `${number(value)} between the bounds ${number(from)} and ${number(to)}; `
      + `${range ? "range" : "95 %"}: ${intervalText(profile ?? range ?? linearised)}` });
  /** @type {(name: string, interval: Interval | null) => void} */
  const add = (name, interval) => {
    if (!interval) return;
    const [left, right] = [interval.low === null ? 0 : placeOf(interval.low),
      interval.high === null ? 1 : placeOf(interval.high)];
    const element = h("span", { class: name });
    element.style.left = `${100 * left}%`;
    element.style.width = `${100 * (right - left)}%`;
    bar.append(element);
  };
  add("linearised", linearised);
  add("profile", profile ?? range);
  if (value !== null) {
    const tick = h("span", { class: "value" });
    tick.style.left = `${100 * placeOf(value)}%`;
    bar.append(tick);
  }
  return bar;
}
