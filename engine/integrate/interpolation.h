// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "engine/dynamics/state_layout.h"
#include "engine/integrate/stepper.h"

namespace engine {

/// State inside an accepted step: quintic in the coordinates (from q, qd, qdd at both ends) with its
/// derivative for their rates, cubic for the others. Contact is stiff: a cubic in q would be wrong by a part
/// of the penetration.
/// @param s  position in the step, 0 to 1
void interpolate_state(const StepPoint& start, const StepPoint& end, const StateLayout& layout, double s,
                       Eigen::VectorXd& y);

}  // namespace engine
