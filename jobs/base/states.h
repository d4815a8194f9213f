// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace jobs {

enum class JobState { kQueued, kRunning, kSucceeded, kFailed, kCancelled };
inline constexpr std::array<std::string_view, 5> kJobStates{"queued", "running", "succeeded", "failed",
                                                            "cancelled"};
[[nodiscard]] inline std::string_view state_name(JobState state) {
  return kJobStates[static_cast<std::size_t>(state)];
}

/// States of searches and wear studies.
inline constexpr std::array<std::string_view, 4> kStudyStates{"running", "succeeded", "failed", "cancelled"};

}  // namespace jobs
