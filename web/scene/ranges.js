// SPDX-License-Identifier: Apache-2.0
// Ranges of channels over the whole run, which the picture of a described linkage needs before it is drawn.
import { findTrajectory } from "/core/api.js";

const points = 200;  // the service keeps the extremes, however few points it gives

/** @typedef {Record<string, [number, number]>} Ranges  least and largest value by the name of the channel */

/// Least and largest values of channels in a whole run.
/** @param {Api.Job} job  @param {string[]} channels  @param {AbortSignal} signal  @returns {Promise<Ranges>} */
export async function rangesOf(job, channels, signal) {
  if (channels.length === 0) return {};
  const columns = await findTrajectory(job.id, { channels: ["t_s", ...channels], points: points * channels.length },
    signal);
  return Object.fromEntries(channels.map((name) => [name, [Math.min(...columns[name]), Math.max(...columns[name])]]));
}
