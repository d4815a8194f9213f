// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/kernel/newton/tree_recursion.h"

#include <cstddef>
#include <type_traits>

#include "engine/math/small_inverse.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

template <typename Scalar>
TreeRecursion<Scalar>::TreeRecursion(const TreeModel& model)
    : model_(model), layout_{.free = static_cast<int>(model.free.size())}, bodies_(model.joints.size()) {}

template <typename Scalar>
void TreeRecursion<Scalar>::set_operating_point(const OperatingPointView& point) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const TreeJoint& joint = model_.joints[i];
    body.R = point.frames[i].R;
    body.p = point.frames[i].p;
    body.axes = point.axes[i];
    body.nominal = point.nominal[i];
    for (int k = 0; k < joint.count(); ++k) {
      body.coordinates[k] = point.nominal_coordinates[joint.first + k];
      body.damper_power_by_rate[k] = 2.0 * joint.damping[k] * point.qd[joint.first + k];
    }
  }
}

template <typename Scalar>
bool TreeRecursion<Scalar>::factor(const Scalar& shift) {
  shift_ = shift;
  inverse_shift_ = 1.0 / shift;
  for (Body& body : bodies_)
    for (Row9<Scalar>& row : body.articulated_tangent) row = {};
  bool regular = true;
  for (std::size_t i = bodies_.size(); i-- > 0;) regular = eliminate_joint(i) && regular;
  return regular;
}

template <typename Scalar>
void TreeRecursion<Scalar>::solve(const NumbersAt<Scalar>& rhs, Workspace<Scalar>& work) const {
  tip_to_base(&rhs, work);
  base_to_tip(&rhs, work);
}

template <typename Scalar>
void TreeRecursion<Scalar>::solve(Workspace<Pack8>& work) const {
  tip_to_base<Pack8>(nullptr, work);
  base_to_tip<Pack8>(nullptr, work);
}

/// Eliminates the rates of a joint: D^-1, U, and, if the parent moves, the gain and the parent's articulated
/// tangent.
template <typename Scalar>
bool TreeRecursion<Scalar>::eliminate_joint(std::size_t i) {
  const TreeJoint& joint = model_.joints[i];
  Body& body = bodies_[i];
  if (!joint.moves) return true;
  const int count = joint.driven ? 0 : joint.count();
  CoordinateTangent<TailPack> seed[3];
  for (int k = 0; k < count; ++k) {
    const TailPack one = unit<Scalar, kTail>(kFirstRate + k);
    seed[k] = {true, inverse_shift_ * one, one, shift_ * one};  // (K28)
  }
  JointForce<TailPack> tail = calc_joint_force(i, unit_tangent_ninth<Scalar, kTail>(), seed);
  Scalar D[3][3];
  for (int k = 0; k < count; ++k)
    for (int m = 0; m < count; ++m) D[k][m] = number_in(tail.residual[k], kFirstRate + m);
  const bool regular = joint.driven || invert_small(count, D, body.D_inverse);
  const ForceNumbers<TailPack> on_parent(tail.on_parent);
  for (int row = 0; row < kForces; ++row)
    for (int k = 0; k < count; ++k) body.U[row][k] = number_in(*on_parent.of[row], kFirstRate + k);
  if (joint.parent_moves) add_to_parent(i, count, tail);
  return regular;
}

/// The gain, Eq. (K30), and P_parent += P' + U gain, Eq. (K31).
/// @param count  of dqd
/// @param tail   the joint's force by the ninth number of chi_parent, and by dqd
template <typename Scalar>
void TreeRecursion<Scalar>::add_to_parent(std::size_t i, int count, JointForce<TailPack> tail) {
  const TreeJoint& joint = model_.joints[i];
  Body& body = bodies_[i];
  const CoordinateTangent<Pack8> none[3];
  JointForce<Pack8> first8 = calc_joint_force(i, unit_tangents_first8<Scalar>(), none);
  Pack8 gain_first8[3]{};
  Scalar gain_ninth[3]{};
  for (int k = 0; k < count; ++k)
    for (int m = 0; m < count; ++m) {
      gain_first8[k] -= body.D_inverse[k][m] * first8.residual[m];
      gain_ninth[k] -= body.D_inverse[k][m] * number_in(tail.residual[m], 0);
    }
  if (joint.driven) {
    gain_first8[0] = first8.residual[0];
    gain_ninth[0] = number_in(tail.residual[0], 0);
  }
  for (int k = 0; k < joint.count(); ++k) body.gain[k].set(gain_first8[k], gain_ninth[k]);
  const ForceNumbers<Pack8> first8_on_parent(first8.on_parent);
  const ForceNumbers<TailPack> tail_on_parent(tail.on_parent);
  Body& parent = bodies_[joint.parent];
  for (int row = 0; row < kForces; ++row) {
    Pack8 P_first8 = parent.articulated_tangent[row].first8() + *first8_on_parent.of[row];
    Scalar P_ninth = parent.articulated_tangent[row].ninth() + number_in(*tail_on_parent.of[row], 0);
    for (int k = 0; k < count; ++k) {
      P_first8 += body.U[row][k] * gain_first8[k];
      P_ninth += body.U[row][k] * gain_ninth[k];
    }
    parent.articulated_tangent[row].set(P_first8, P_ninth);
  }
}

/// The joint's force and residual by the tangents of the parent's frame and of the joint's coordinates.
/// @param f     tangent of the parent's frame
/// @param seed  of the joint's coordinates
template <typename Scalar>
template <typename T>
auto TreeRecursion<Scalar>::calc_joint_force(
    std::size_t i, FrameTangent<T> f, const CoordinateTangent<T>* seed) const -> JointForce<T> {
  const TreeJoint& joint = model_.joints[i];
  const Body& body = bodies_[i];
  Vec3<T> joint_rotation;
  calc_frame_tangent(joint, body.axes, body.nominal, body.coordinates, seed, f, joint_rotation);  // (K17)
  SpatialForce<T> force = calc_newton_euler_tangent(joint, body.R, body.nominal, f);              // (K18)
  add_articulated_force(body.articulated_tangent, f, force);                                      // (K29)
  return shift_to_parent(i, seed, joint_rotation, force);
}

/// Shifts the force of a subtree to its parent, and converts its tangent from corotational with the body to
/// corotational with the parent: the transmitted force rotates with the joint, Eq. (K21). The residual is its
/// part along the joint's axes, springs and dampers with it.
/// @param force  of the subtree, about the body's origin
template <typename Scalar>
template <typename T>
auto TreeRecursion<Scalar>::shift_to_parent(
    std::size_t i, const CoordinateTangent<T>* seed, const Vec3<T>& joint_rotation,
    SpatialForce<T> force) const -> JointForce<T> {
  const TreeJoint& joint = model_.joints[i];
  const Body& body = bodies_[i];
  const SpatialForce<double>& nominal = body.nominal.force;
  const auto& axis = body.axes.axis;
  JointForce<T> result;
  if (joint.rotates() && seed[0].active) {
    force.force += cross(joint_rotation, nominal.force);
    force.moment += cross(joint_rotation, nominal.moment);
  }
  for (int k = 0; k < joint.count(); ++k) {
    result.residual[k] = joint.rotates() ? dot(axis[k], force.moment) : dot(axis[k], force.force);
    if (!seed[k].active) continue;
    for (int m = 0; m < k; ++m)  // each axis rotates with those before it
      result.residual[k] -= dot(axis[k], cross(axis[m], nominal.moment)) * seed[m].q;
    if (joint.sprung) result.residual[k] += joint.stiffness[k] * seed[k].q + joint.damping[k] * seed[k].qd;
  }
  result.on_parent = force;
  result.on_parent.moment += cross(body.axes.r, force.force);
  if (!joint.rotates() && seed[0].active)
    result.on_parent.moment += seed[0].q * cross(axis[0], nominal.force);
  return result;
}

/// Tangent of a free coordinate with dqd = 0: Eq. (K28).
template <typename Scalar>
template <typename T>
CoordinateTangent<T> TreeRecursion<Scalar>::rhs_tangent(const TreeJoint& joint, int k,
                                                        const NumbersAt<Scalar>* rhs) const {
  if constexpr (std::is_same_v<T, Scalar>) {
    const int i = joint.first_free + k;
    return {true, inverse_shift_ * (*rhs)[layout_.q(i)], T{}, -(*rhs)[layout_.v(i)]};
  } else {
    return {true, T{}, T{}, T{}};
  }
}

/// local_qd of each joint, and p_0 of its subtree to its parent: Eqs. (K30), (K31).
template <typename Scalar>
template <typename T>
void TreeRecursion<Scalar>::tip_to_base(const NumbersAt<Scalar>* rhs, Workspace<T>& work) const {
  for (std::size_t i = bodies_.size(); i-- > 0;) {
    const TreeJoint& joint = model_.joints[i];
    const Body& body = bodies_[i];
    CoordinateTangent<T> seed[3];
    Vec3<T> joint_rotation;
    SpatialForce<T>& force = work.bias_force[i];
    if (rhs && !joint.driven) {
      for (int k = 0; k < joint.count(); ++k) seed[k] = rhs_tangent<T>(joint, k, rhs);
      FrameTangent<T> f;
      calc_frame_tangent(joint, body.axes, body.nominal, body.coordinates, seed, f, joint_rotation);
      force += calc_newton_euler_tangent(joint, body.R, body.nominal, f);
      add_articulated_force(body.articulated_tangent, f, force);
    }
    JointForce<T> joint_force = shift_to_parent(i, seed, joint_rotation, force);
    T* local_qd = &work.local_qd[joint.first];
    if (joint.driven) {
      local_qd[0] = joint_force.residual[0];
    } else {
      for (int k = 0; k < joint.count(); ++k) {
        local_qd[k] = T{};
        for (int m = 0; m < joint.count(); ++m) local_qd[k] -= body.D_inverse[k][m] * joint_force.residual[m];
      }
      const ForceNumbers<T> on_parent(joint_force.on_parent);
      for (int row = 0; row < kForces; ++row)
        for (int k = 0; k < joint.count(); ++k) *on_parent.of[row] += body.U[row][k] * local_qd[k];
    }
    if (joint.parent >= 0) work.bias_force[joint.parent] += joint_force.on_parent;
  }
}

/// dqd = local_qd + gain chi_parent, Eq. (K30), and the tangent of each frame.
template <typename Scalar>
template <typename T>
void TreeRecursion<Scalar>::base_to_tip(const NumbersAt<Scalar>* rhs, Workspace<T>& work) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const TreeJoint& joint = model_.joints[i];
    const Body& body = bodies_[i];
    const T* local_qd = &work.local_qd[joint.first];
    T qd[3];
    for (int k = 0; k < joint.count(); ++k) qd[k] = local_qd[k];
    FrameTangent<T> f;
    if (joint.parent_moves) {
      f = work.frames[joint.parent];
      const FrameNumbers<T> chi_parent(f);
      for (int k = 0; k < joint.count(); ++k) qd[k] += apply_row(body.gain[k], chi_parent);
    }
    if (joint.driven) work.drive_force[joint.drive] = qd[0];
    if (!joint.moves) continue;
    CoordinateTangent<T> seed[3];
    for (int k = 0; k < joint.count() && !joint.driven; ++k) {
      work.qd[joint.first_free + k] = qd[k];
      seed[k] = rhs_tangent<T>(joint, k, rhs);
      seed[k].q += inverse_shift_ * qd[k];
      seed[k].qd = qd[k];
      seed[k].qdd += shift_ * qd[k];
    }
    Vec3<T> joint_rotation;
    calc_frame_tangent(joint, body.axes, body.nominal, body.coordinates, seed, f, joint_rotation);
    work.frames[i] = f;
  }
}

template <typename Scalar>
Scalar TreeRecursion<Scalar>::calc_damper_power(const Buffer<Scalar>& qd) const {
  Scalar power{};
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const TreeJoint& joint = model_.joints[i];
    for (int k = 0; k < joint.count() && !joint.driven; ++k)
      power += bodies_[i].damper_power_by_rate[k] * qd[joint.first_free + k];
  }
  return power;
}

template class TreeRecursion<double>;
template class TreeRecursion<Complex<double>>;

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
