// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "jobs/trajectories/trajectory_text.h"

namespace jobs {

// The bytes of to_csv() and to_json_columns(). The view has been loaded.
[[nodiscard]] std::unique_ptr<TrajectoryText> csv_text(TrajectoryView view);
[[nodiscard]] std::unique_ptr<TrajectoryText> json_text(TrajectoryView view);

}  // namespace jobs
