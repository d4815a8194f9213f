// SPDX-License-Identifier: Apache-2.0
// Peaks of curves, from the metrics: these are found inside the integration's steps, curves join samples.
import { nameOfChannel, number, timeMetricOf, unitOf } from "/core/format.js";
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
  const textOf = (name) => `${number(metrics?.[name], digits)} ${unitOf(channel)}${timeText(metrics, name)}`;
  const key = names.find(isKnown);
  // Accelerations count from run_up_s on. A run that ends before has only the other.
  const whole = names.map(wholeRunOf).find((name) => name !== key && isKnown(name));
  const texts = [key && `${textOf(key)}${whole ? " from run_up_s on" : ""}`, whole && `${textOf(whole)} in the whole run`];
  return texts.filter(Boolean).join(", ") || null;
}

/// Time of a channel's peak, of an acceleration from run_up_s on; undefined if there is none.
/** @param {Api.Job} job  @param {string} channel  @returns {number | undefined} */
export function peakTime({ metrics }, channel) {
  /** @type {Record<string, unknown>} */
  const known = metrics ?? {};
  const time = namesOf(channel).map((name) => known[timeMetricOf(name)]).find((each) => typeof each === "number");
  return typeof time === "number" ? time : undefined;
}

const wholeRunOf = (key) => key.replace(unitOfAcceleration, "_whole_run_$1");

function timeText(metrics, key) {
  const time = metrics[timeMetricOf(key)];
  return typeof time === "number" ? ` at ${number(time, 6)} s` : "";
}

/// The peaks of what a plot shows, for below it; empty if the metrics have none.
/** @param {Api.Job[]} jobs  @param {string[]} channels  @param {string[]} axes  of the jobs' sweep */
export function peakNote(jobs, channels, axes) {
  const labels = labelsOf(jobs, axes);
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
