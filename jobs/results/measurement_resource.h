// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/results/resource_json.h"
#include "jobs/store/rows.h"

namespace jobs {

/// Measurement as users see it: {"id", "name", "created_at", "bytes", "links"} and what measurement_json()
/// has. A listing leaves out the runs.
[[nodiscard]] nlohmann::json measurement_resource(const MeasurementRow& row, Detail detail);

/// The keys that items of a listing may have.
[[nodiscard]] const std::vector<std::string>& measurement_listing_keys();

}  // namespace jobs
