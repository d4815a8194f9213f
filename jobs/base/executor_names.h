// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace jobs {

inline constexpr std::string_view kLocalExecutor = "local";
inline constexpr std::string_view kSlurmExecutor = "slurm";
inline constexpr std::array<std::string_view, 2> kExecutorNames{kLocalExecutor, kSlurmExecutor};

}  // namespace jobs
