// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/dynamics/kernel/newton/row9.h"
#include "engine/dynamics/kernel/tangent/frame_tangent.h"
#include "engine/dynamics/kernel/tangent/nominal_motion.h"
#include "engine/dynamics/kernel/tangent/operating_point.h"
#include "engine/dynamics/newton_euler.h"
#include "engine/dynamics/state_layout.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/complex.h"
#include "engine/math/lanes.h"
#include "engine/math/number_rows.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The Newton system (sigma 1 - J) x = b of the open chains, without contacts, solved in O(n) by the
/// recursion of ArticulatedBodies.
///
/// The unknowns are dqd, the tangents of the free rates. With them and the right-hand side (b_q, b_v) the
/// other tangents of a free coordinate are known, Eq. (K28):
///
///     dq = (dqd + b_q) / sigma,   dqdd = sigma dqd - b_v
///
/// so that the tangent chi = (w, wd, vd) of a frame is linear in that of its parent's frame and in the
/// joint's dqd. The steps are those of ArticulatedBodies, with chi instead of the acceleration:
///
///     (K29)  articulated tangent  p = P chi + p_0: the force that the children pass to a body, by the
///            tangent of its frame (6 x 9); the body's own force (K18) is added
///     (K30)  joint residual       r = Q chi_parent + D dqd + r_0 = 0: balance along the joint's axes
///            gain                 dqd = local_qd + gain chi_parent,  local_qd = -D^-1 r_0,  gain = -D^-1 Q
///     (K31)  to the parent        P_parent += P' + U gain,  p_0,parent += p_0' + U local_qd
///
/// with U the force on the parent by dqd, and P', p_0' that with dqd = 0. Equation numbers are those of
/// kernel/README.md.
/// @tparam Scalar  double or Complex<double>, as the shift sigma is
template <typename Scalar>
class TreeRecursion {
 public:
  /// Eight numbers side by side.
  using Pack8 = typename NumbersOf<Scalar>::template Block<Lanes::kCount>;

  /// Forces and tangents of a solution, or of several side by side. @tparam T  Scalar or Pack8
  template <typename T>
  struct Workspace {
    explicit Workspace(const TreeModel& model)
        : bias_force(model.joints.size()),
          local_qd(model.coordinates),
          frames(model.joints.size()),
          qd(model.free.size()),
          drive_force(model.drives.size()) {}
    /// one a joint; in: tangent of the load on the body, negative; out: force on the joint's subtree with
    /// chi_parent = 0 and the joint's dqd = 0; local_qd of the joints in the subtree is in it
    Buffer<SpatialForce<T>> bias_force;
    Buffer<T> local_qd;  ///< dqd with chi_parent = 0, of a driven joint its force; one a coordinate
    Buffer<FrameTangent<T>> frames;      ///< out, one a joint
    Buffer<T> qd;                        ///< out, dqd: one a free coordinate
    Buffer<T> drive_force;               ///< out, one a drive
  };

  /// @param model  must outlive this
  explicit TreeRecursion(const TreeModel& model);

  /// Copies the operating point.
  void set_operating_point(const OperatingPointView& point);

  /// Eliminates all joints, tip to base. False if a D is singular.
  [[nodiscard]] bool factor(const Scalar& shift);

  /// Solves for dqd, after factor(). @param rhs  (b_q, b_v)
  void solve(const NumbersAt<Scalar>& rhs, Workspace<Scalar>& work) const;
  /// The same of eight loads at once, with (b_q, b_v) = 0.
  void solve(Workspace<Pack8>& work) const;

  /// Tangent of the frame of a joint's body, with its origin at p.
  template <typename T>
  [[nodiscard]] FrameTangent<T> tangent_at_point(int joint, const Vec3<double>& p,
                                                 const Workspace<T>& work) const {
    return joint < 0
               ? FrameTangent<T>{}
               : shift_origin(work.frames[joint], offset_from_origin(joint, p));
  }
  /// From the origin of a joint's body to p.
  [[nodiscard]] Vec3<double> offset_from_origin(int joint, const Vec3<double>& p) const {
    return joint < 0 ? p : p - bodies_[joint].p;
  }

  /// Power of all dampers by the tangents of the rates.
  [[nodiscard]] Scalar calc_damper_power(const Buffer<Scalar>& qd) const;

 private:
  static constexpr int kForces = 6;             ///< force and moment
  static constexpr int kFirstRate = 1;          ///< lane of the first dqd in a TailPack
  static constexpr int kTail = kFirstRate + 3;
  /// The ninth number of x, and a joint's three dqd.
  using TailPack = typename NumbersOf<Scalar>::template Block<kTail>;

  /// A body and the joint that carries it.
  struct Body {
    // Of the operating point
    Mat3<double> R;
    Vec3<double> p;
    JointAxes axes;
    NominalJoint nominal;
    NominalCoordinate coordinates[3];
    double damper_power_by_rate[3];
    // Of factor()
    Row9<Scalar> articulated_tangent[kForces];  ///< P of the children's subtrees, about the body's origin
    Scalar U[kForces][3];                       ///< force on the parent by dqd
    Scalar D_inverse[3][3];                     ///< of the joint residual by dqd
    Row9<Scalar> gain[3];                       ///< dqd, or of a driven joint its force, by chi_parent
  };
  /// The force that a joint passes to its parent, and the residual of its balance.
  template <typename T>
  struct JointForce {
    SpatialForce<T> on_parent;  ///< about the parent's origin
    T residual[3];              ///< r, along each axis
  };

  [[nodiscard]] bool eliminate_joint(std::size_t i);
  void add_to_parent(std::size_t i, int count, JointForce<TailPack> tail);
  template <typename T>
  [[nodiscard]] JointForce<T> calc_joint_force(std::size_t i, FrameTangent<T> f,
                                               const CoordinateTangent<T>* seed) const;
  template <typename T>
  [[nodiscard]] JointForce<T> shift_to_parent(std::size_t i, const CoordinateTangent<T>* seed,
                                              const Vec3<T>& joint_rotation, SpatialForce<T> force) const;
  template <typename T>
  [[nodiscard]] CoordinateTangent<T> rhs_tangent(const TreeJoint& joint, int k,
                                                 const NumbersAt<Scalar>* rhs) const;
  template <typename T>
  void tip_to_base(const NumbersAt<Scalar>* rhs, Workspace<T>& work) const;
  template <typename T>
  void base_to_tip(const NumbersAt<Scalar>* rhs, Workspace<T>& work) const;

  const TreeModel& model_;
  StateLayout layout_;  ///< of (q, v)
  Scalar shift_{1.0}, inverse_shift_{1.0};
  Buffer<Body> bodies_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
