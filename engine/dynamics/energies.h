// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/kinematics/frame_motion.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Kinetic energy of the bodies, [J].
[[nodiscard]] double calc_kinetic_energy(const Mechanism& mechanism, const std::vector<FrameMotion>& frames,
                                         const Eigen::VectorXd& qd);

/// Energy of gravity (zero at the global origin) and of all springs, [J].
[[nodiscard]] double calc_potential_energy(const Mechanism& mechanism, const std::vector<FrameMotion>& frames,
                                           const Eigen::VectorXd& q);

}  // namespace engine
