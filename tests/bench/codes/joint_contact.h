// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "engine/model/mechanism.h"
#include "tests/bench/codes/joint_forces.h"

namespace bench {

/// The forces of a cut joint with clearance whose contact is in closed form.
[[nodiscard]] std::unique_ptr<JointForces> make_joint_forces(const engine::CutJoint& joint);

}  // namespace bench
