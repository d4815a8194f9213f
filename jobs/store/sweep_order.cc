// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/sweep_order.h"

#include <vector>

namespace jobs {
namespace {

/// A sweep that has queued jobs.
struct WaitingSweep {
  std::int64_t seq = kSingleJobs;
  std::int64_t priority = 0;
};

/// Jumps from one sweep to the next in the index of queued jobs, so its cost is that of their number, however
/// many jobs each has.
std::vector<WaitingSweep> find_waiting_sweeps(Statements& statements, const ExecutorFilter& filter) {
  const auto waiting = statements.use(
      "WITH RECURSIVE next (sweep) AS ("
      "  SELECT min(sweep) FROM jobs WHERE state = 'queued' AND batch IS NULL AND sweep > 0"
      "  UNION ALL"
      "  SELECT (SELECT min(j.sweep) FROM jobs j WHERE j.state = 'queued' AND j.batch IS NULL AND j.sweep > "
      "next.sweep)"
      "  FROM next WHERE next.sweep IS NOT NULL)"
      " SELECT next.sweep, s.priority FROM next JOIN sweeps s ON s.seq = next.sweep WHERE "
      "coalesce(s.executor, ?1) = ?2"
      " UNION ALL SELECT 0, 0 WHERE ?1 = ?2 AND EXISTS (SELECT 1 FROM jobs WHERE state = 'queued' AND batch "
      "IS NULL AND sweep IS NULL)");
  waiting->bind(1, filter.default_executor);
  waiting->bind(2, filter.executor);
  std::vector<WaitingSweep> sweeps;
  while (waiting->executeStep()) sweeps.push_back({.seq = waiting->getColumn(0).getInt64(),
                                                   .priority = waiting->getColumn(1).getInt64()});
  return sweeps;
}

}  // namespace

std::set<SweepTurn> order_of_sweeps(Statements& statements, const ExecutorFilter& filter,
                                    const std::map<std::int64_t, std::uint64_t>& served) {
  std::set<SweepTurn> order;
  for (const WaitingSweep& sweep : find_waiting_sweeps(statements, filter)) {
    const auto found = served.find(sweep.seq);
    order.insert({.negative_priority = -sweep.priority,
                  .served = found == served.end() ? 0 : found->second,
                  .sweep = sweep.seq});
  }
  return order;
}

}  // namespace jobs
