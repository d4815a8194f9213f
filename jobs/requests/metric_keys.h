// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace jobs {

/// Parts of a study's request that its metrics depend on.
inline constexpr std::array<std::string_view, 3> kPartsWithMetrics{"parameters", "sweep", "over"};

/// Metrics of the jobs of a request: those of all the linkages that its jobs have, each key once. A joint
/// whose clearance is 0 in some jobs has the metrics of its contact in the others.
/// @param request  of a sweep, or those parts of a study; its parameters and cases have no faults
[[nodiscard]] std::vector<std::string> metric_keys_of(const nlohmann::json& request);

/// Fault of the name of a metric; empty if there is none.
/// @param known  metrics that there are; empty: unknown
[[nodiscard]] std::string describe_metric_fault(const nlohmann::json& metric,
                                                const std::vector<std::string>& known);

}  // namespace jobs
