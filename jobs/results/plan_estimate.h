// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "jobs/requests/expand.h"
#include "jobs/store/plan_costs.h"

namespace jobs {

/// Cost of a sweep before it is submitted: {"jobs", "stored_jobs", "new_jobs", "seconds", "bytes",
/// "measured_jobs", "unmeasured_kinds"}. Jobs of one kind cost what those in the store did, by their
/// simulated time and their samples; seconds and bytes are null where a kind has none there.
/// @param threads  jobs computed at a time
[[nodiscard]] nlohmann::json plan_estimate_json(const SweepPlan& plan, const PlanCosts& costs, int threads);

}  // namespace jobs
