// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/model/rpsup_parameters.h"
#include "validation/engine_names.h"

namespace validation {

/// Bearing or journal at one instant: 4x4 transform into the global frame and its rate.
struct PartMotion {
  Eigen::Matrix4d T, T_d;
};

/// A place where journal and bearing touch, and the force on the journal there; on the bearing acts the
/// opposite, Eq. (10).
struct ContactPoint {
  Eigen::Vector3d p_W, force_W;
};

/// All contacts of the joint with clearance in its continuum form, each at the instant of its onset: the
/// penetration rate is that of the onset, and the friction's bristles are not yet bent. Eqs. (11.1), (11.2),
/// with K by Hertz from the parameters.
[[nodiscard]] std::vector<ContactPoint> find_fresh_contacts(const RpsupParameters& parameters,
                                                            const PartMotion& b, const PartMotion& j);

}  // namespace validation
