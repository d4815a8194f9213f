// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace jobs {

/// Parameter that says which results of a job are kept. It stands among completed parameters only if it is
/// kKeepMetrics: the others are those of a job that does not name it.
inline constexpr std::string_view kKeepKey = "keep";
inline constexpr std::string_view kKeepAll = "all";
inline constexpr std::string_view kKeepMetrics = "metrics";
inline constexpr std::array<std::string_view, 2> kKeepWords{kKeepAll, kKeepMetrics};
inline constexpr std::string_view kKeepHelp = "Results that are kept; metrics: no trajectory";

/// Empty if the value is one of kKeepWords.
[[nodiscard]] inline std::string describe_keep_fault(const nlohmann::json& value) {
  return value == kKeepAll || value == kKeepMetrics ? "" : "must be \"all\" or \"metrics\"";
}

/// @tparam Json  nlohmann::json or nlohmann::ordered_json
template <typename Json>
[[nodiscard]] bool keeps_metrics_alone(const Json& parameters) {
  const auto keep = parameters.find(kKeepKey);
  return keep != parameters.end() && *keep == kKeepMetrics;
}

inline constexpr std::string_view kNeedsTrajectories =
    "must be \"all\": the study reads the trajectories of its jobs";

}  // namespace jobs
