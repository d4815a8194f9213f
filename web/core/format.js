// SPDX-License-Identifier: Apache-2.0
// The one place that writes numbers, names and units.

// The first that fits counts.
const suffixes = [
  ["_n_m_a", "N m/A"], ["_rad_m", "rad/m"], ["_ohm", "Ω"], ["_h", "H"],
  ["_n_m_s_rad", "N m s/rad"], ["_n_m_rad", "N m/rad"], ["_deg", "°"], ["_n_s_m", "N s/m"], ["_s_m", "s/m"],
  ["_1_m", "1/m"], ["_1_s", "1/s"], ["_j_m", "J m"],
  ["_m_s2", "m/s²"], ["_rad_s2", "rad/s²"], ["_rad_s", "rad/s"], ["_m_s", "m/s"], ["_n_m", "N m"], ["_kg_m2", "kg m²"],
  ["_kg", "kg"], ["_mrad", "mrad"],
  ["_rad", "rad"], ["_mm", "mm"], ["_um", "µm"], ["_hz", "Hz"], ["_pa", "Pa"], ["_n", "N"], ["_j", "J"], ["_s", "s"],
  ["_a", "A"], ["_v", "V"], ["_w", "W"],
  ["_m", "m"],
];

const minus = "−";

/// A number in four significant digits, or as many as asked for.
/** @param {number | string | null | undefined} value  @param {number} digits */
export function number(value, digits = 4) {
  if (value === null || value === undefined) return "–";
  if (typeof value !== "number") return String(value);
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-3 ? value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e")
    : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", minus);
}

/// A parameter's value as it was given, to the last digit.
/** @param {number | string | null | undefined} value */
export function exact(value) {
  return typeof value === "number" ? String(value).replaceAll("-", minus) : value === null || value === undefined ? "–"
    : String(value);
}

/** @param {string} column */
export function unitOf(column) {
  if (column.endsWith("stiffness_n_m")) return "N/m"; // of torques the same letters are N m
  return suffixes.find(([suffix]) => column.endsWith(suffix))?.[1] ?? "";
}

/** @param {string} column */
const withoutUnit = (column) => {
  const suffix = suffixes.find(([ending]) => column.endsWith(ending))?.[0] ?? "";
  return column.slice(0, column.length - suffix.length);
};

/// The metric of a peak's time: peak_x_time_s of peak_x_m_s2.
/** @param {string} peak */
export const timeMetricOf = (peak) => `${withoutUnit(peak)}_time_s`;

const insideLinkage = /^linkage\.((bodies|joints|springs|loads|accelerometers)\.)?/;

/// "peak_slider_acceleration_m_s2" as "Peak slider acceleration",
/// "linkage.joints.crank.drive.velocity_rad_s" as "Crank drive velocity".
/** @param {string} column */
export function nameOf(column) {
  const words = withoutUnit(column).replace(/^links\.([^.]+)\./, "link ($1) ")
    // "clearance.clearance_mm" is one word, too.
    .replace(insideLinkage, "").replaceAll(/[_.]/g, " ").replace(/\b([a-z]+) \1$/, "$1").trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/// Kinds of channels that the names of described linkages leave to the unit.
/** @type {[RegExp, string][]} */
const kindsOfChannels = [[/_(rad|m)_s2$/, "acceleration"], [/_(rad|m)_s$/, "velocity"], [/_rad$/, "angle"],
  [/_drive_n$/, "force"], [/_drive_n_m$/, "torque"]];

/// A channel by what it shows: "crank_rad_s2" as "Crank acceleration".
/** @param {string} channel */
export function nameOfChannel(channel) {
  const kind = kindsOfChannels.find(([unit]) => unit.test(channel))?.[1] ?? "";
  return kind === "" || channel.includes(kind) ? nameOf(channel) : `${nameOf(channel)} ${kind}`;
}

/// A channel by what it shows, with its unit.
/** @param {string} channel */
export function titleOfChannel(channel) {
  const unit = unitOf(channel);
  return unit ? `${nameOfChannel(channel)} [${unit}]` : nameOfChannel(channel);
}

/// A name with its unit: "Peak slider acceleration [m/s²]". @param unit  where the suffix does not say it rightly
/** @param {string} column  @param {string} unit */
export function titleOf(column, unit = unitOf(column)) {
  return unit ? `${nameOf(column)} [${unit}]` : nameOf(column);
}

/// A value of an axis, short: "10 rad/s", "rigid", "rigid elements 4".
/** @param {string} axis  @param {number | string | null | undefined} value */
export function pointOf(axis, value) {
  const unit = unitOf(axis);
  if (typeof value !== "number") return String(value ?? "–");
  return unit ? `${number(value, 6)} ${unit}` : `${nameOf(axis).toLowerCase()} ${number(value, 6)}`;
}

/// A time span: "12 s", "3 min 20 s", "2 h 5 min".
/** @param {number | null | undefined} seconds */
export function span(seconds) {
  if (seconds === null || seconds === undefined) return "unknown";
  if (seconds < 10) return `${Number(seconds.toPrecision(2))} s`;
  const whole = Math.round(seconds);
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  const minutes = Math.round(whole / 60);
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

/** @param {number} count */
export function bytes(count) {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let power = 0;
  let rest = count;
  for (; rest >= 1000 && power < units.length - 1; power += 1) rest /= 1000;
  return `${number(rest, 3)} ${units[power]}`;
}

/** @param {string | null} text */
export function moment(text) {
  return text ? new Date(text).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "medium" }) : "–";
}

/// A moment in few letters: "27 Nov 2026, 22:21".
/** @param {string | null} text */
export function shortMoment(text) {
  return text ? new Date(text).toLocaleString(undefined, { day: "numeric", month: "short", year: "numeric",
    hour: "2-digit", minute: "2-digit", hourCycle: "h23" }) : "–";
}

/** @param {number} count  @param {string} word */
export function plural(count, word) {
  return `${count.toLocaleString("en")} ${count === 1 ? word : `${word}s`}`;
}
