// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/plan_costs.h"

namespace jobs {
namespace {

/// However long ago they were computed: a walk along all jobs, at worst.
constexpr const char* kCostOfKind =
    "SELECT count(*), total(r.wall_time_s), total(d), total(length(t.data)), "
    "total(d * json_extract(c.parameters, '$.output_rate_hz')) FILTER (WHERE t.data IS NOT NULL), "
    "total(length(c.parameters) + length(r.metrics)) FROM (SELECT result, content FROM jobs WHERE kind = ? "
    "AND state = 'succeeded' AND reused = 0 ORDER BY seq DESC LIMIT 200) j JOIN results r ON r.seq = "
    "j.result JOIN (SELECT seq, parameters, json_extract(parameters, '$.duration_s') AS d FROM contents) c "
    "ON c.seq = j.content LEFT JOIN trajectories t ON t.result = r.seq";

KindCost read_kind_cost(SQLite::Statement& find, const std::string& kind) {
  find.reset();
  find.bind(1, kind);
  find.executeStep();
  return {.measured = find.getColumn(0).getInt64(),
          .seconds = find.getColumn(1).getDouble(),
          .simulated_s = find.getColumn(2).getDouble(),
          .trajectory_bytes = find.getColumn(3).getDouble(),
          .samples = find.getColumn(4).getDouble(),
          .other_bytes = find.getColumn(5).getDouble()};
}

}  // namespace

PlanCosts read_plan_costs(const SQLite::Database& database, const SweepPlan& plan) {
  PlanCosts costs;
  SQLite::Statement find_kind(database, kCostOfKind);
  SQLite::Statement find_result(
      database,
      "SELECT 1 FROM contents c JOIN results r ON r.content = c.seq WHERE c.content_id = ? AND "
      "r.error_reason IS NULL LIMIT 1");
  for (const PlannedJob& job : plan.jobs) {
    if (!costs.kinds.contains(job.kind)) costs.kinds[job.kind] = read_kind_cost(find_kind, job.kind);
    find_result.reset();
    find_result.bind(1, job.content_id);
    if (plan.reuse && find_result.executeStep()) costs.stored.insert(job.content_id);
  }
  return costs;
}

}  // namespace jobs
