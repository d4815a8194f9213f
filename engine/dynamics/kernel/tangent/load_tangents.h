// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/dynamics/kernel/tangent/frame_tangent.h"
#include "engine/dynamics/kernel/tangent/nominal_motion.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/dual_vec3.h"
#include "engine/math/lanes.h"
#include "engine/math/vec3.h"
#include "engine/model/drive_law.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A number with its tangents by a pack of seeds.
using TangentDual = DualOf<TangentPack::kCount>;

/// A frame with all accelerations of the operating point, and its inertial (not corotational) tangents, Eq.
/// (K16).
[[nodiscard]] RPSUP_INLINE Frame<TangentDual, TangentDual> add_inertial_tangent(
    const Frame<double, double>& frame, const NominalJoint& nominal, const FrameTangent<TangentPack>& f) {
  const auto rotated = [&](const Vec3<double>& v)
                           RPSUP_INLINE_LAMBDA { return join(v, cross(f.rotation, v)); };
  const auto rotated_plus = [&](const Vec3<double>& v, const Vec3<TangentPack>& corotational)
                                RPSUP_INLINE_LAMBDA { return join(v, corotational + cross(f.rotation, v)); };
  return {{rotated(frame.R.x), rotated(frame.R.y), rotated(frame.R.z)},
          join(frame.p, f.translation),
          rotated_plus(nominal.w, f.w),
          rotated_plus(nominal.v, f.v),
          rotated_plus(nominal.wd, f.wd),
          rotated_plus(nominal.vd, f.vd)};
}

/// Adds the tangents of applied forces to those of the forces on the coordinates.
/// @param force  out, one an applied force  @param tau  one a coordinate
RPSUP_INLINE void add_applied_force_tangents(const TreeModel& model, const AppliedForceValue* values,
                                             const CoordinateTangent<TangentPack>* seeds,
                                             const TangentPack& time, TangentPack* force, TangentPack* tau) {
  for (std::size_t k = 0; k < model.applied_forces.size(); ++k) {
    const AppliedForce& of = model.applied_forces[k];
    force[k] = values[k].by_t * time;
    for (std::size_t i = 0; i < kForceInputs; ++i) {
      if (of.inputs[i] < 0) continue;
      const CoordinateTangent<TangentPack>& seed = seeds[of.inputs[i]];
      force[k] += values[k].by_q[i] * seed.q + values[k].by_v[i] * seed.qd;
    }
    tau[of.coordinate] += force[k];
  }
}

/// Tangents of the right-hand sides of the couplings' rows. @param lambda  out, one a row
RPSUP_INLINE void calc_coupling_tangents(const TreeModel& model, const CoordinateTangent<TangentPack>* seeds,
                                         TangentPack* lambda) {
  for (std::size_t k = 0; k < model.couplings.size(); ++k) {
    const Coupling& coupling = model.couplings[k];
    const CoordinateTangent<TangentPack>& a = seeds[coupling.coordinate];
    const CoordinateTangent<TangentPack>& b = seeds[coupling.follows];
    lambda[model.first_coupling_row + k] = -(a.qdd - coupling.ratio * b.qdd) -
                                           2.0 * model.alpha * (a.qd - coupling.ratio * b.qd) -
                                           (model.beta * model.beta) * (a.q - coupling.ratio * b.q);
  }
}

/// The same for the rows of enforced drives, if any: their motion has a tangent by time only.
RPSUP_INLINE void calc_drive_row_tangents(const TreeModel& model, const CoordinateTangent<TangentPack>* seeds,
                                          const TangentPack& time, const DrivenMotion* drives,
                                          TangentPack* lambda) {
  if (!model.drive_rows) return;
  for (std::size_t k = 0; k < model.drives.size(); ++k) {
    const CoordinateTangent<TangentPack>& seed = seeds[model.drives[k]];
    lambda[model.first_drive_row + k] = drives[k].qddd * time -
                                        2.0 * model.alpha * (seed.qd - drives[k].qdd * time) -
                                        (model.beta * model.beta) * (seed.q - drives[k].qd * time);
  }
}

/// Adds the tangents of the forces of the joints' springs and dampers. @param tau  one a coordinate
template <typename Topology>
RPSUP_INLINE void add_joint_spring_tangents(const TreeModel& model,
                                            const CoordinateTangent<TangentPack>* seeds, TangentPack* tau) {
  Topology::for_each_joint(model, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
    if (!joint.sprung) return;
    for (int k = 0; k < joint.count(); ++k) {
      const int i = joint.first + k;
      if (seeds[i].active)
        tau[i] -= joint.data().stiffness[k] * seeds[i].q + joint.data().damping[k] * seeds[i].qd;
    }
  });
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
