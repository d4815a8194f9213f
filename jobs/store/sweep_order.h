// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "jobs/runs/executor.h"
#include "jobs/store/store_connection.h"

namespace jobs {

inline constexpr std::int64_t kSingleJobs = 0;

/// SQL of the condition that no other job of the same content is being computed anywhere, so that j need not
/// wait for its result.
inline constexpr const char* kNobodyComputesIt =
    "(j.reuse = 0 OR NOT EXISTS (SELECT 1 FROM jobs r WHERE r.content = j.content AND r.state = 'running') "
    "AND NOT EXISTS (SELECT 1 FROM jobs r WHERE r.content = j.content AND r.batch IS NOT NULL))";

/// Place of a sweep in the scheduling order, which is that of its members; single jobs come last of equals.
struct SweepTurn {
  std::int64_t negative_priority = 0;
  std::uint64_t served = 0;  ///< number of the claim that last served the sweep; 0: none has
  std::int64_t sweep = kSingleJobs;

  auto operator<=>(const SweepTurn& other) const {
    const auto key = [](const SweepTurn& turn) {
      return std::tuple(turn.negative_priority, turn.served, turn.sweep == kSingleJobs, turn.sweep);
    };
    return key(*this) <=> key(other);
  }
};

/// Scheduling order of the sweeps that have jobs for an executor: highest priority first, then least recently
/// served. kSingleJobs stands for jobs without a sweep.
/// @param served  number of the claim that last served a sweep; sweeps that are not in it come first, oldest
///     first
[[nodiscard]] std::set<SweepTurn> order_of_sweeps(Statements& statements, const ExecutorFilter& filter,
                                                  const std::map<std::int64_t, std::uint64_t>& served);

/// Scheduling order of each executor, kept from claim to claim: with thousands of waiting sweeps, finding the
/// order takes longer than many jobs do. A sweep without queued jobs may still stand in it.
struct SweepTurns {
  std::map<std::string, std::set<SweepTurn>> of_executor;
  std::string default_executor;
  std::uint64_t order_version = 0;  ///< Writer::order_version() that the order knows of

  /// Adds a sweep that the transaction at hand has made, so that the order need not be found again.
  /// @param now  Writer::order_version() within that transaction
  void add(const std::string& executor, const SweepTurn& turn, std::uint64_t now) {
    if (order_version + 1 != now) return;
    order_version = now;
    const auto found = of_executor.find(executor.empty() ? default_executor : executor);
    if (found != of_executor.end()) found->second.insert(turn);
  }
};

}  // namespace jobs
