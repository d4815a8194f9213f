// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace jobs {

/// Position of a job's linkage at t = 0: {"poses": {LINK: [x_m, y_m, z_m, qx, qy, qz, qw]},
/// "undriven_freedoms"}. Links as the channels name them: pose_LINK_x_m. The number is that of
/// engine::count_undriven_freedoms(), null for RPSUP.
/// @param parameters  of the job
/// @throws InvalidRequest with every fault
[[nodiscard]] nlohmann::json find_assembly(const nlohmann::json& parameters);

}  // namespace jobs
