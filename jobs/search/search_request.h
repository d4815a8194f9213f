// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/parameters/range.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/sweep_request.h"
#include "jobs/search/limit.h"

namespace jobs {

/// Keys of a request.
inline constexpr std::array<std::string_view, 10> kSearchRequestKeys{
    "name", "parameters", "over", "metric", "bound", "quantile", "sweep", "replicates", "reuse", "priority"};
inline constexpr Range kFirstRange{.minimum = 2, .maximum = 1000};
inline constexpr std::uint64_t kDefaultFirst = 5;
inline constexpr Range kQuantileRange{.minimum = 0.0, .maximum = 1.0, .lower = Bound::kExclusive};
inline constexpr Range kToleranceRange{.minimum = 0.0, .lower = Bound::kExclusive};

/// Request of a search: the last value of a parameter before a metric first exceeds its bound, for each
/// combination of the axes.
struct SearchRequest {
  SweepRequest common;    ///< name, parameters, axes, replicates, reuse and priority of all jobs
  std::string parameter;  ///< path of the one whose limit is searched
  SearchInterval interval;
  std::string metric;
  LimitRule rule;
};

/// Reads {"name", "parameters", "over": {parameter: {"from", "to", "scale", "tolerance", "first"}}, "metric",
/// "bound", "quantile", "sweep", "replicates", "reuse", "priority"}; over, metric and bound are needed.
/// @throws InvalidRequest with every fault
[[nodiscard]] SearchRequest parse_search_request(const nlohmann::ordered_json& request, std::size_t max_jobs);

/// The values of the axes of each combination, the last axis fastest; one empty list if there are no axes.
[[nodiscard]] std::vector<std::vector<nlohmann::json>> combinations_of(const SearchRequest& search);

/// A point of the search as a case of a sweep.
[[nodiscard]] nlohmann::ordered_json case_at(const SearchRequest& search,
                                             const std::vector<nlohmann::json>& combination, double x);

/// The sweep of a search without cases. @param request  as parse_search_request has read it
[[nodiscard]] nlohmann::ordered_json common_sweep_of_search(const nlohmann::ordered_json& request);

/// The sweep whose cases are the first evaluations of a search; others are added to it as extensions.
/// @param request  as parse_search_request has read it
[[nodiscard]] nlohmann::ordered_json first_sweep_of(const nlohmann::ordered_json& request,
                                                    const SearchRequest& search);

/// The jobs of that sweep. @throws InvalidRequest with every fault, with pointers into the search's request
[[nodiscard]] SweepPlan plan_first_sweep(const nlohmann::ordered_json& sweep, const SearchRequest& search,
                                         std::size_t max_jobs);

}  // namespace jobs
