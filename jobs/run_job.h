// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "engine/analysis/quantities.h"
#include "engine/analysis/run_result.h"

namespace jobs {

/// A job computed on the spot, without a store.
struct Outcome {
  nlohmann::json job;             ///< as GET /v1/jobs/{id} shows it, without an id
  engine::Trajectory trajectory;  ///< as far as the run came
};

/// @throws InvalidRequest with every fault
[[nodiscard]] Outcome run_job(const nlohmann::json& parameters, const engine::StopQuery& stop_requested);

}  // namespace jobs
