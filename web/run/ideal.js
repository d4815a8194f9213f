// SPDX-License-Identifier: Apache-2.0
// The run of the ideal linkage that a job is compared with: same drives, rigid links, no clearance.
import { findJob, submitJob } from "/core/api.js";

const pollMs = 300;
/** @type {Pick<Api.Parameters, "coupler" | "crank" | "rod" | "cross">} */
const rigid = { coupler: "rigid", crank: "rigid", rod: "rigid", cross: "rigid" };

/// Submits the run of the ideal linkage, which the store may have already. Resolves to the job, once it has succeeded.
/** @param {Api.Job} job  @param {AbortSignal} signal */
export async function idealOf(job, signal) {
  let ideal = await submitJob({ ...job.parameters, clearance_mm: 0, axial_clearance_mm: 0, ...rigid,
    drive: "prescribed" });
  while (ideal.state === "queued" || ideal.state === "running") {
    await new Promise((resolve) => { setTimeout(resolve, pollMs); });
    ideal = await findJob(ideal.id, signal);
  }
  if (ideal.state !== "succeeded") throw new Error(`The ideal linkage's run is ${ideal.state}.`);
  return ideal;
}

/** @param {Api.Job} job */
export function isIdeal({ parameters }) {
  return parameters.clearance_mm === 0 && Object.entries(rigid).every(([link, model]) => parameters[link] === model);
}
