#pragma once

#include <Eigen/Core>

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/journal_motion.h"
#include "engine/clearance/normal_force.h"

namespace engine {

/// One place where journal and bore touch: r from the journal centre, n the outward normal of the bore, both in {b}.
struct RadialTouch {
  Eigen::Vector3d r;
  Eigen::Vector3d n;             ///< in the bearing's cross-section: n.z() = 0
  NormalForce normal;
  double rate = 0.0;             ///< penetration rate, [m/s]
};

/// Adds normal force and friction of one touch to the load.
/// @param bristle       (t, axial) components of the deflection, t = e_b x n; may be null: no bristle to read or move
/// @param bristle_rate  where its rate goes
void add_radial_touch(const ClearanceParameters& joint, const JournalMotion& journal, const RadialTouch& touch, const double* bristle,
                      double* bristle_rate, ContactLoad& load);

/// Axial position of a ring on the journal: evenly spaced over the length, a single one in the middle.
[[nodiscard]] inline double ring_position(const ClearanceParameters& joint, int ring) {
  return joint.n_r == 1 ? 0.0 : joint.L_b * (static_cast<double>(ring) / (joint.n_r - 1) - 0.5);
}

}  // namespace engine
