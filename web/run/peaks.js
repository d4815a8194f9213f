// SPDX-License-Identifier: Apache-2.0
// Peaks of curves, from the metrics: these are found inside the integration's steps, curves join samples.
import { nameOfChannel, number, unitOf } from "/core/format.js";
import { labelsOf } from "/run/labels.js";

const unitOfAcceleration = /_((m|rad)_s2)$/;
const digits = 5;  // as in the table of the metrics

/// Metrics that may be the peak of a channel. Accelerations of a described linkage are called so in the
/// metrics alone.
/** @type {(channel: string) => string[]} */
const namesOf = (channel) => [channel, channel.replace(unitOfAcceleration, "_acceleration_$1")]
  .map((name) => `peak_${name}`);

/// The metrics' peak of a channel in words; null if they have none.
/** @param {Api.Job} job  @param {string} channel */
function peakOf({ metrics }, channel) {
  const names = namesOf(channel);
  const isKnown = (name) => typeof metrics?.[name] === "number";
  const textOf = (name) => `${number(metrics?.[name], digits)} ${unitOf(channel)}`;
  const key = names.find(isKnown);
  if (key) return unitOfAcceleration.test(key) ? `${textOf(key)}${steadyText(metrics, key)}` : textOf(key);
  // A run that ends before its steady part has only this one.
  const whole = names.map(wholeRunOf).find(isKnown);
  return whole ? `${textOf(whole)} in the whole run` : null;
}

/// Time of an acceleration's peak from run_up_s on; undefined if there is none.
/** @param {Api.Job} job  @param {string} channel  @returns {number | undefined} */
export function peakTime({ metrics }, channel) {
  /** @type {Record<string, unknown>} */
  const known = metrics ?? {};
  const time = namesOf(channel).map((name) => known[timeOf(name)]).find((each) => typeof each === "number");
  return typeof time === "number" ? time : undefined;
}

/** @type {(metric: string) => string} */
const timeOf = (metric) => metric.replace(unitOfAcceleration, "_time_s");

const wholeRunOf = (key) => key.replace(unitOfAcceleration, "_whole_run_$1");

/// Accelerations count from run_up_s on; of some it is known when that was.
function steadyText(metrics, key) {
  const at = metrics[timeOf(key)];
  const whole = metrics[wholeRunOf(key)];
  return `${typeof at === "number" ? ` at ${number(at, 6)} s` : ""} from run_up_s `
    + `on, ${number(whole, digits)} ${unitOf(key)} in the whole run`;
}

/// The peaks of what a plot shows, for below it; empty if the metrics have none.
/** @param {Api.Job[]} jobs  @param {string[]} channels */
export function peakNote(jobs, channels) {
  const labels = labelsOf(jobs);
  const nameFor = (channel, j) => [channels.length > 1 && nameOfChannel(channel),
    jobs.length > 1 && labels[j]].filter(Boolean).join(", ");
  const peaks = jobs.flatMap((job, j) => channels.map((channel) => [nameFor(channel, j), peakOf(job, channel)]))
    .filter(([, peak]) => peak !== null);
  if (peaks.length === 0) return "";
  const rates = [...new Set(jobs.map((job) => job.parameters.output_rate_hz))].map((rate) => number(rate, 6))
    .join(" and ");
  return `Peak magnitude: ${peaks.map((words) => words.join(" ").trim()).join("; ")}. Peaks include values between `
    + `the samples, which the curve joins at ${rates} Hz.`;
}
