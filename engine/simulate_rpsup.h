// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/analysis/run_result.h"
#include "engine/model/rpsup_parameters.h"

namespace engine {

/// Refuses parameters that are no linkage: values out of bounds, an inertia no body can have, a guide out of
/// reach of the coupler somewhere in the motion.
/// @throws InvalidInput for the first fault; its field is the name of the member, "links.1,3.inertia" for a
/// link's, "reach" where
///         no single one is at fault.
void check_parameters(const RpsupParameters& parameters, const RunOptions& options);

/// Simulates one linkage from rest in its assembled position.
/// The same parameters give the same bytes, whatever else the process does.
/// @throws InvalidInput as check_parameters does.
[[nodiscard]] RunResult simulate_rpsup(const RpsupParameters& parameters, const RunOptions& options,
                                       const StopQuery& stop_requested);

}  // namespace engine
