// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/kernel/topology/static_joint.h"
#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/instruction_set.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Subtracts a force that acts at p on a joint's body from the body's bias force.
/// @param frames, bias_force  one a joint
template <typename Frames, typename Forces>
RPSUP_INLINE void subtract_point_force(int joint, const Vec3<double>& p, const Vec3<double>& force,
                                       const Frames& frames, Forces& bias_force) {
  if (joint < 0) return;
  SpatialForce<double>& on_body = bias_force[joint];
  on_body.force -= force;
  on_body.moment -= cross(p - frames[joint].p, force);
}

/// Subtracts the load of a joint's contacts from the bias forces of its bodies. The load acts on the journal
/// at its centre, and the opposite there on the bearing.
template <typename Joint, typename Frames, typename Forces>
RPSUP_INLINE void subtract_contact_load(const Joint& joint, const CutJointMotion<double, double>& cut,
                                        const Frames& frames, Forces& bias_force) {
  if (joint.journal_joint >= 0) {
    SpatialForce<double>& on_journal = bias_force[joint.journal_joint];
    on_journal.force -= cut.reaction;
    on_journal.moment -= cut.moment;
    if (joint.journal.shifted)
      on_journal.moment -=
          cross(cut.j.p - frames[joint.journal_joint].p, cut.reaction);
  }
  if (joint.bearing_joint >= 0) {
    SpatialForce<double>& on_bearing = bias_force[joint.bearing_joint];
    on_bearing.force += cut.reaction;
    on_bearing.moment +=
        cut.moment + cross(cut.j.p - frames[joint.bearing_joint].p, cut.reaction);
  }
}

/// Forces of the joints' springs and dampers on the coordinates; zero on the others. @param q, qd, tau  one a
/// coordinate
template <typename Topology, typename Coordinates>
RPSUP_INLINE void calc_joint_spring_forces(const TreeModel& model, const Coordinates& q,
                                           const Coordinates& qd, Coordinates& tau) {
  Topology::for_each_joint(model, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
    for_each_coordinate(joint, [&](int k) RPSUP_INLINE_LAMBDA {
      const int i = joint.first + k;
      tau[i] = joint.sprung ? -(joint.data().stiffness[k] * q[i] + joint.data().damping[k] * qd[i]) : 0.0;
    });
  });
}

/// Adds the applied forces to the forces on the coordinates. @param tau  one a coordinate
template <typename Coordinates>
RPSUP_INLINE void add_applied_forces(const TreeModel& model, const AppliedForceValue* values,
                                     Coordinates& tau) {
  for (std::size_t k = 0; k < model.applied_forces.size(); ++k)
    tau[model.applied_forces[k].coordinate] += values[k].force;
}

/// Accelerations of the auxiliary joints, or their tangents. Their bodies turn about principal axes.
/// @param tau, qdd  one a coordinate
template <typename Topology, typename Coordinates>
RPSUP_INLINE void calc_auxiliary_accelerations(const TreeModel& model, const Coordinates& tau,
                                               Coordinates& qdd) {
  Topology::for_each_auxiliary(model, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
    qdd[joint.first] = tau[joint.first] * (1.0 / joint.data().I[4 * joint.axis]);
  });
}

/// Adds the powers of the joints' dampers. @param qd  one a coordinate
template <typename Topology, typename Coordinates>
RPSUP_INLINE void add_damper_power(const TreeModel& model, const Coordinates& qd, double& power) {
  Topology::for_each_joint(model, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
    if (!joint.sprung) return;
    for_each_coordinate(joint, [&](int k) RPSUP_INLINE_LAMBDA {
      const double rate = qd[joint.first + k];
      power += joint.data().damping[k] * (rate * rate);
    });
  });
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
