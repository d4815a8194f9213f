// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/requests/expand.h"

namespace jobs {

/// Request and jobs that extend a sweep to the union of its request and an addition.
struct Extension {
  nlohmann::ordered_json request;  ///< the union; equal to the former one if there is nothing new
  std::vector<PlannedJob> jobs;    ///< those that the sweep does not have, in the order of the union
};

/// Adds values to the axes of a sweep, and cases to its cases: `{"sweep": {axis: values}, "cases": [...]}`.
/// The swept parameters stay the same; values and cases that the sweep has already are left out.
/// @param former  a request that has been planned before
/// @throws InvalidRequest with every fault, with pointers into the addition
[[nodiscard]] Extension plan_extension(const nlohmann::ordered_json& former,
                                       const nlohmann::ordered_json& addition, std::size_t max_jobs);

}  // namespace jobs
