// SPDX-License-Identifier: Apache-2.0
// Labels that tell jobs apart.
import { pointOf } from "/core/format.js";

/// A short name for each of the jobs: the parameters in which they differ, or the end of the id where they do not.
/** @param {Api.Job[]} jobs */
export function labelsOf(jobs) {
  const [first] = jobs;
  const differing = Object.keys(first.parameters)
    .filter((key) => typeof first.parameters[key] !== "object"
      && jobs.some((job) => job.parameters[key] !== first.parameters[key]));
  const labels = jobs.map((job) => differing.map((key) => pointOf(key, job.parameters[key])).join(", "));
  const unique = new Set(labels).size === jobs.length;
  return labels.map((label, j) => (unique ? label : `${label} …${jobs[j].id.slice(-5)}`.trim()));
}
