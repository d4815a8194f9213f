// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/requests/expand.h"

namespace jobs {

/// What has to be done so that a sweep becomes what the union of its request and an addition asks for.
struct Extension {
  nlohmann::ordered_json request;  ///< the union; equal to the former one if there is nothing new
  std::vector<PlannedJob> jobs;    ///< those that the sweep does not have, in the order of the union
};

/// Adds values to the axes of a sweep, and cases to its cases: `{"sweep": {axis: values}, "cases": [...]}`. What is swept stays; values
/// and cases that the sweep has already are left out.
/// @param former  a request that has been planned before
/// @throws InvalidRequest with every fault, with pointers into the addition
[[nodiscard]] Extension plan_extension(const nlohmann::ordered_json& former, const nlohmann::ordered_json& addition, std::size_t max_jobs);

}  // namespace jobs
