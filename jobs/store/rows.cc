// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/rows.h"

namespace jobs {

std::string_view sweep_state(const StateCounts& counts) {
  const auto count = [&](JobState state) { return counts[static_cast<std::size_t>(state)]; };
  if (!has_ended(counts)) {
    const bool untouched = count(JobState::kRunning) + count(JobState::kSucceeded) +
                               count(JobState::kFailed) + count(JobState::kCancelled) ==
                           0;
    return state_name(untouched ? JobState::kQueued : JobState::kRunning);
  }
  if (count(JobState::kCancelled) > 0) return state_name(JobState::kCancelled);
  return state_name(count(JobState::kFailed) > 0 ? JobState::kFailed : JobState::kSucceeded);
}

bool has_ended(const StateCounts& counts) {
  return counts[static_cast<std::size_t>(JobState::kQueued)] +
             counts[static_cast<std::size_t>(JobState::kRunning)] ==
         0;
}

}  // namespace jobs
