// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/clearance/contact_derivative.h"
#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/kernel/forward/forward_dynamics.h"
#include "engine/dynamics/kernel/tangent/nominal_motion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Addresses of the parts of an operating point, for readers that do not know its topology.
struct OperatingPointView {
  const Frame<double, double>* frames;           ///< one a joint
  const JointAxes* axes;                         ///< one a joint
  const NominalJoint* nominal;                   ///< one a joint
  const NominalCoordinate* nominal_coordinates;  ///< one a coordinate
  const CutJointMotion<double, double>* cuts;    ///< one a cut joint
  const std::unique_ptr<ContactDerivative>* contacts;  ///< one a joint with clearance
  const ActingBristles* acting;                  ///< one a joint with clearance
  const double* qd;                              ///< one a coordinate
};

/// The operating point of a linearisation: what the tangents of all seeds share.
/// @tparam Topology  DynamicTopology or a StaticTopology
template <typename Topology>
class OperatingPoint {
 public:
  /// @param dynamics  must outlive this, and be evaluated before set()
  OperatingPoint(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles,
                 const ForwardDynamics<Topology>& dynamics)
      : nominal(model.joints.size()),
        coordinates(model.coordinates),
        acting(joints.size()),
        model_(model),
        joints_(joints),
        dynamics_(dynamics),
        bristle_index_(bristles) {
    ground.vd = {-model.gravity[0], -model.gravity[1], -model.gravity[2]};
    for (const ClearanceJoint& joint : joints)
      contacts.push_back(
          std::make_unique<ContactDerivative>(static_cast<std::size_t>(joint.bristle_count())));
  }

  /// Computes all below from the last evaluation of the dynamics. Much code with two callers: not inlined
  /// into both.
  /// @param acting_bristles  those that touch or are bent, in pairs, ascending
  [[gnu::noinline]] void set(const double* bristles, const int* acting_bristles, int acting_count) {
    sort_acting_bristles(acting_bristles, acting_count);
    set_nominal_motion();
    set_nominal_loads(bristles);
    Topology::tip_to_base(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.parent < 0) return;
      const SpatialForce<double>& force = nominal[i].force;
      SpatialForce<double>& parent = nominal[joint.parent].force;
      parent.force += force.force;
      parent.moment += force.moment + cross(dynamics_.axes[i].r, force.force);
    });
  }

  [[nodiscard]] OperatingPointView view() const {
    return {dynamics_.frames.data(), dynamics_.axes.data(), nominal.data(), coordinates.data(),
            dynamics_.cuts.data(),   contacts.data(),       acting.data(),  dynamics_.qd.data()};
  }

  NominalJoint ground;
  Buffer<NominalJoint> nominal;
  Buffer<NominalCoordinate> coordinates;
  std::vector<std::unique_ptr<ContactDerivative>> contacts;  ///< of each joint with clearance
  Buffer<ActingBristles> acting;                             ///< of each joint with clearance

 private:
  /// Sorts the acting bristles by joints.
  RPSUP_INLINE void sort_acting_bristles(const int* acting_bristles, int count) {
    int first = 0, next = 0;
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const int end = first + joints_[k].bristle_count();
      ActingBristles& of_joint = acting[k];
      of_joint = {first, bristle_index_.data() + next, 0};
      for (; next < count && acting_bristles[next] < end; ++next, ++of_joint.count)
        bristle_index_[next] = acting_bristles[next] - first;
      first = end;
    }
  }

  RPSUP_INLINE void set_nominal_motion() {
    Topology::base_to_tip(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      const int first = joint.first;
      const NominalJoint& parent =
          joint.parent < 0 ? ground : nominal[joint.parent];
      calc_nominal_joint(joint, parent, dynamics_.axes[i], &dynamics_.qd[first], &dynamics_.qdd[first],
                         &coordinates[first], nominal[i]);
      calc_nominal_force(joint, dynamics_.frames[i].R, nominal[i]);
    });
  }

  /// Loads of contacts, with their derivatives, of ideal joints, and of point springs.
  RPSUP_INLINE void set_nominal_loads(const double* bristles) {
    for (std::size_t k = 0; k < model_.cut_joints.size(); ++k) {
      const TreeCutJoint& joint = model_.cut_joints[k];
      const CutJointMotion<double, double>& cut = dynamics_.cuts[k];
      if (!joint.has_clearance()) {
        subtract_load(joint.journal_joint, cut.j.p, cut.reaction, cut.moment);
        subtract_load(joint.bearing_joint, bearing_point(joint.rows, cut.b, cut.j), -cut.reaction,
                      -cut.moment);
        continue;
      }
      const int index = joint.clearance;
      contacts[index]->calc(joints_[index], cut.journal, bristles, acting[index]);
      subtract_load(joint.journal_joint, cut.j.p, cut.reaction, cut.moment);
      subtract_load(joint.bearing_joint, cut.j.p, -cut.reaction, -cut.moment);
    }
    if constexpr (Topology::has_point_springs) {
      for (std::size_t k = 0; k < model_.springs.size(); ++k) {
        const PointSpringForce<double>& spring = dynamics_.spring_forces[k];
        subtract_load(model_.springs[k].to_joint, spring.to, spring.force, {});
        subtract_load(model_.springs[k].from_joint, spring.from, -spring.force, {});
      }
      for (std::size_t k = 0; k < model_.body_loads.size(); ++k) {
        const BodyLoadForce<double>& load = dynamics_.body_loads[k];
        subtract_load(model_.body_loads[k].joint, load.p, load.force, load.moment);
      }
    }
  }

  /// Subtracts the load on a joint's body of a force at p, with a moment about p.
  RPSUP_INLINE void subtract_load(int joint, const Vec3<double>& p, const Vec3<double>& force,
                                  const Vec3<double>& moment) {
    if (joint < 0) return;
    SpatialForce<double>& on_body = nominal[joint].force;
    on_body.force -= force;
    on_body.moment -= moment + cross(p - dynamics_.frames[joint].p, force);
  }

  const TreeModel& model_;
  const std::vector<ClearanceJoint>& joints_;
  const ForwardDynamics<Topology>& dynamics_;
  Buffer<int> bristle_index_;  ///< of `acting`
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
