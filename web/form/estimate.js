// SPDX-License-Identifier: Apache-2.0
// Estimate of a request's cost, from earlier jobs of the same kind.
import { findResults, listJobs } from "/core/api.js";

const lookedAt = 400;
const mostSweeps = 6;
// A sample of a trajectory: 25 channels and seven numbers for each link, three bytes each, by half smaller when
// compressed.
const bytesPerNumber = 1.6;
/// Links that may be flexible, and into how many elements each is divided then.
const elementsOf = { coupler: "rigid_elements", crank: "crank_elements", rod: "rod_elements", cross: "cross_elements" };
const kindPaths = [...Object.keys(elementsOf), "clearance_mm", "duration_s"];

/// Seconds of computing for each simulated second, by kind of job.
export async function measureCosts(signal) {
  const { items } = await listJobs({ limit: lookedAt, state: "succeeded", fields: "id,sweep_id,run" }, signal);
  const measured = new Map(items.flatMap(({ id, run }) => (run && !run.reused ? [[id, run.cpu_time_s]] : [])));
  const sweeps = [...new Set(items.map((job) => job.sweep_id).filter(Boolean))].slice(0, mostSweeps);
  const kinds = new Map();
  for (const id of sweeps) {
    const rows = await findResults(id, { fields: "job_id,coupler,crank,rod,cross,clearance_mm,duration_s" }, signal);
    for (const row of rows.filter(({ job_id: job }) => measured.has(job))) {
      const kind = kinds.get(kindOf(row)) ?? { seconds: 0, simulated: 0 };
      kinds.set(kindOf(row),
        { seconds: kind.seconds + measured.get(row.job_id), simulated: kind.simulated + row.duration_s });
    }
  }
  return kinds;
}

/// Linkages that are described have no coupler by that name.
/** @type {(row: any) => string} */
const kindOf = ({ coupler, crank, rod, cross, clearance_mm: clearance }) => {
  if (coupler === null) return "described linkages";
  const flexible = Object.entries({ crank, rod, cross }).filter(([, model]) => model === "flexible");
  return `${[coupler, ...flexible.map(([link]) => link)].join(" + ")}, ${clearance > 0 ? "clearance" : "ideal joint"}`;
};

/// @param defaults  the value of each parameter that a request leaves out
/// @returns {seconds, unknown, bytes}: seconds of computing on one core; kinds of which no job has been measured
export function estimate(request, defaults, jobs, costs) {
  const cases = request.cases?.length ? request.cases : [{}];
  const unknown = new Set();
  let seconds = 0;
  let size = 0;
  let sets = 0;
  for (const each of cases) {
    const values = (path) => axisValues(request.sweep?.[path] ?? request.design?.over?.[path])
      ?? [each[path] ?? request.parameters?.[path] ?? defaults[path]];
    const described = typeof (each.linkage ?? request.parameters?.linkage) === "object";
    for (const set of combinations(kindPaths, (path) => (described && path in elementsOf ? [null] : values(path)))) {
      const { duration_s: duration } = set;
      const kind = kindOf(set);
      const cost = costs.get(kind);
      if (cost) seconds += (cost.seconds / cost.simulated) * duration;
      else unknown.add(kind);
      const links = Object.entries(elementsOf)
        .reduce((sum, [link, elements]) => sum + (set[link] === "flexible" ? values(elements)[0] - 1 : 0), 5);
      size += duration * values("output_rate_hz")[0] * (25 + 7 * links) * bytesPerNumber;
      sets += 1;
    }
  }
  return { seconds: (seconds / sets) * jobs, bytes: (size / sets) * jobs, unknown: [...unknown] };
}

/// Every choice of one value for each path.
/** @param {string[]} paths  @param {(path: string) => any[]} values  @returns {Generator<any>} */
function* combinations([path, ...others], values) {
  if (path === undefined) yield {};
  else for (const value of values(path)) for (const rest of combinations(others, values)) yield { [path]: value,
    ...rest };
}

function axisValues(axis) {
  if (axis === undefined || Array.isArray(axis)) return axis;
  if (axis.count === undefined) return [axis.from, axis.to];  // of a design: anywhere between
  const ratio = (k) => (axis.count > 1 ? k / (axis.count - 1) : 0);
  const at = (k) => (axis.scale === "log" ? axis.from * (axis.to / axis.from) ** ratio(k) : axis.from
    + (axis.to - axis.from) * ratio(k));
  return Array.from({ length: Math.min(axis.count, 10000) }, (_, k) => at(k));
}
