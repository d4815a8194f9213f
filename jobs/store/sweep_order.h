// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "jobs/runs/executor.h"
#include "jobs/store/store_connection.h"

namespace jobs {

inline constexpr std::int64_t kSingleJobs = 0;

/// SQL: that no other job of the same content is being computed anywhere, so that j need not wait for its
/// result.
inline constexpr const char* kNobodyComputesIt =
    "(j.reuse = 0 OR NOT EXISTS (SELECT 1 FROM jobs r WHERE r.content = j.content AND r.state = 'running') "
    "AND NOT EXISTS (SELECT 1 FROM jobs r WHERE r.content = j.content AND r.batch IS NOT NULL))";

/// Scheduling order of the sweeps that have jobs for an executor: highest priority first, then least recently
/// served. kSingleJobs stands for jobs without a sweep.
/// @param served  number of the claim that last served a sweep; sweeps that are not in it come first, oldest
///     first
[[nodiscard]] std::vector<std::int64_t> order_of_sweeps(Statements& statements, const ExecutorFilter& filter,
                                                        const std::map<std::int64_t, std::uint64_t>& served);

}  // namespace jobs
