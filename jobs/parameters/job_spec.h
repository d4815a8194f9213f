// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "engine/model/linkage.h"
#include "engine/model/rpsup_parameters.h"
#include "engine/model/run_options.h"

namespace jobs {

/// Input of the engine for one job.
struct JobSpec {
  engine::RpsupParameters parameters;
  engine::RunOptions options;
  std::optional<engine::Linkage> linkage{};  ///< a described linkage; empty: RPSUP
  bool keeps_trajectory = true;              ///< whether the trajectory is stored
};

}  // namespace jobs
