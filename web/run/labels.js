// SPDX-License-Identifier: Apache-2.0
// Labels that tell jobs apart.
import { pointOf } from "/core/format.js";
import { leavesOf, variedIn } from "/run/described.js";

/// A short name for each of the jobs: the parameters in which they differ, or the end of the id where they do not.
/// @param axes  of their sweep: masses of links count where they are varied, for others follow from lengths
/** @param {Api.Job[]} jobs  @param {string[]} axes */
export function labelsOf(jobs, axes) {
  const values = jobs.map((job) => {
    const { linkage, ...others } = job.parameters;
    return { ...others, ...(typeof linkage === "object" ? leavesOf(linkage, "linkage") : {}),
      ...Object.fromEntries(variedIn(job, axes)) };
  });
  const [first] = values;
  const differing = Object.keys(first)
    .filter((key) => typeof first[key] !== "object" && values.some((each) => each[key] !== first[key]));
  const labels = values.map((each) => differing.filter((key) => key in each)
    .map((key) => pointOf(key, each[key])).join(", "));
  const unique = new Set(labels).size === jobs.length;
  return labels.map((label, j) => (unique ? label : `${label} …${jobs[j].id.slice(-5)}`.trim()));
}
