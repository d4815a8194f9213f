// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <nlohmann/json.hpp>

#include "jobs/parameters/range.h"
#include "jobs/requests/sweep_request.h"
#include "jobs/wear/wear.h"
#include "jobs/wear/wear_integrator.h"

namespace jobs {

inline constexpr std::array<std::string_view, 11> kWearStudyKeys{"name",
                                                                 "parameters",
                                                                 "wear_coefficient_m2_n",
                                                                 "sectors",
                                                                 "hours",
                                                                 "worn_clearance_mm",
                                                                 "max_depth_step_um",
                                                                 "max_rate_change",
                                                                 "max_cycles",
                                                                 "reuse",
                                                                 "priority"};
inline constexpr Range kPositiveRange{.minimum = 0.0, .lower = Bound::kExclusive};
inline constexpr Range kDepthStepRange{.minimum = 0.0, .maximum = 1000.0, .lower = Bound::kExclusive};
inline constexpr Range kCyclesRange{.minimum = 1, .maximum = 1000};

/// Request of a wear study: a bearing that is worn over the hours.
struct WearStudyRequest {
  SweepRequest common;       ///< name, parameters, reuse and priority of all jobs
  nlohmann::json completed;  ///< the parameters, with all defaults
  WearQuery query;           ///< coefficient and sectors
  WearRule rule;

  [[nodiscard]] double clearance_mm() const { return completed.at("clearance_mm"); }  ///< of the round bore
  [[nodiscard]] WearGrid round_bore() const {
    return WearGrid(completed.at("radial_levels").get<std::size_t>(),
                    std::vector<double>(query.sectors, 0.0));
  }
};

/// Reads {"name", "parameters", "wear_coefficient_m2_n", "sectors", "hours", "worn_clearance_mm",
/// "max_depth_step_um", "max_rate_change", "max_cycles", "reuse", "priority"}; hours, worn_clearance_mm or
/// both are needed. @throws InvalidRequest with every fault
[[nodiscard]] WearStudyRequest parse_wear_request(const nlohmann::ordered_json& request,
                                                  std::size_t max_jobs);

/// Case of the study's sweep with this bore.
[[nodiscard]] nlohmann::ordered_json case_of(const WearGrid& depth_um);

/// Sweep whose only case is the round bore.
[[nodiscard]] nlohmann::ordered_json first_sweep_of(const nlohmann::ordered_json& request,
                                                    const WearStudyRequest& study);

}  // namespace jobs
