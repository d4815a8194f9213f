// SPDX-License-Identifier: Apache-2.0
// Chooses another job of the same sweep, to be laid over this one.
import { findResults, findSweep } from "/core/api.js";
import { choice } from "/core/dom.js";
import { pointOf } from "/core/format.js";

const mostOffered = 500;

/// A labelled select that calls back with a job's id; null if the job stands alone.
/** @param {Api.Job[]} jobs  @param {(id: string) => void} chosen  @param {AbortSignal} signal */
export async function overlayPicker(jobs, chosen, signal) {
  const { sweep_id: id } = jobs[0];
  if (!id) return null;
  const { axes, request } = await findSweep(id, signal);
  const columns = [...axes, ...(request.replicates ? ["replicate"] : [])];
  const rows = await findResults(id, { fields: ["job_id", "state", ...columns].join(","), limit: mostOffered }, signal);
  const others = rows.filter((row) => row.state === "succeeded" && !jobs.some((job) => job.id === row.job_id));
  if (others.length === 0) return null;
  /** @type {(row: Api.Row) => string} */
  const textOf = (row) => columns.map((column) => pointOf(column, row[column])).join(", ") || `…${row.job_id.slice(-5)}`;
  const more = rows.length < mostOffered ? [] : [["", `the first ${mostOffered} jobs: select others in the sweep`]];
  return choice("Overlay job", [["", "choose …"], ...others.map((row) => [row.job_id, textOf(row)]), ...more], "",
    (job) => job && chosen(job));
}
