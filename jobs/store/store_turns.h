// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "jobs/runs/executor.h"
#include "jobs/store/store_connection.h"

namespace jobs {

inline constexpr std::int64_t kSingleJobs = 0;

/// SQL: that no other job of the same content is being computed anywhere, so that j need not wait for its result.
inline constexpr const char* kNobodyComputesIt =
    "(j.reuse = 0 OR NOT EXISTS (SELECT 1 FROM jobs r WHERE r.content = j.content AND r.state = 'running') "
    "AND NOT EXISTS (SELECT 1 FROM jobs r WHERE r.content = j.content AND r.batch IS NOT NULL))";

/// The sweeps that have jobs which an executor may take, kSingleJobs for those of none: highest priority first, then those that were served
/// longest ago.
/// @param served  which was served when; what is not there never was, and the oldest of those comes first
[[nodiscard]] std::vector<std::int64_t> find_turns(Statements& statements, const Lane& lane, const std::map<std::int64_t, std::uint64_t>& served);

}  // namespace jobs
