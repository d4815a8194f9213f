// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/sweep_order.h"

#include <algorithm>
#include <utility>

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

std::vector<std::int64_t> order_of_sweeps(Statements& statements, const ExecutorFilter& filter,
                                          const std::map<std::int64_t, std::uint64_t>& served) {
  std::vector<WaitingSweep> sweeps = find_waiting_sweeps(statements, filter);
  // Never served counts as longest ago; among those the oldest sweep comes first, since the sort is stable.
  std::ranges::stable_sort(sweeps, {}, [&](const WaitingSweep& sweep) {
    return std::pair(-sweep.priority, served.contains(sweep.seq) ? served.at(sweep.seq) : 0);
  });
  std::vector<std::int64_t> turns;
  for (const WaitingSweep& sweep : sweeps) turns.push_back(sweep.seq);
  return turns;
}

}  // namespace jobs
