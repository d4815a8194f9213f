// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "engine/dynamics/kernel/forward/slender_body.h"
#include "engine/dynamics/kernel/topology/topology.h"
#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/lanes.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Angular acceleration of a frame and linear acceleration of its origin, in W.
template <typename T>
struct SpatialAcceleration {
  Vec3<T> angular, linear;
};

/// Generalised forces of one motion, as the first of several directions.
struct FirstForces {
  const double* tau;
  [[nodiscard]] RPSUP_INLINE FirstForces operator+(int k) const { return {tau + k}; }
  [[nodiscard]] RPSUP_INLINE Directions operator[](int k) const { return Directions::first(tau[k]); }
};
/// In the place of the coordinates' accelerations: nobody asks for them.
template <typename T>
struct NotWanted {
  [[nodiscard]] RPSUP_INLINE NotWanted operator+(int) const { return {}; }
};

/// A vector of one motion, as the first of several directions.
template <typename T>
[[nodiscard]] RPSUP_INLINE Vec3<T> as_first(const Vec3<double>& v) {
  if constexpr (std::is_same_v<T, double>)
    return v;
  else
    return {T::first(v.x), T::first(v.y), T::first(v.z)};
}

/// The equations of motion of the open chains solved body by body, in a time that grows with their number: M qdd = tau - bias without M.
///
/// A body and all that it carries answer an acceleration (alpha, a) of its frame with the force and moment about the frame's origin
///
///     F = A a + C alpha + f,    N = C^T a + J alpha + n
///
/// of which what the joint leaves free is eliminated on the way to the root, and found on the way back. Of a spherical joint nothing but a
/// force passes: A alone is left, a matrix of three. All accelerations here are what the free coordinates add to those of the frames.
/// Source: R. Featherstone, Rigid Body Dynamics Algorithms, chapter 7.
///
/// Shapes: the tree's joints, AnyShapes or known ones.
template <typename Shapes>
class ArticulatedBodies {
  template <typename T>
  using JointRoom = typename Shapes::template JointRoom<T>;

 public:
  explicit ArticulatedBodies(const TreeModel& model) : model_(model), answers_(model.joints.size()), eliminated_(model.joints.size()) {}

  /// Computes the articulated inertias. False if one is not positive definite.
  [[nodiscard]] RPSUP_INLINE bool factor(const Frame<double, double>* frames, const JointAxes* axes) {
    bool definite = true;
    Shapes::inwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.moves) return;
      Answer& answer = answers_[i];
      add_body(joint, frames[i].R, answer);
      definite = eliminate(joint, frames[i].R, answer, axes[i].axis[0], eliminated_[i]) && definite;
      if (joint.parent_moves) carry(joint, answer, axes[i].r, answers_[static_cast<std::size_t>(joint.parent)]);
    });
    return definite;
  }

  /// Room for solve().
  template <typename T>
  struct Scratch {
    explicit Scratch(const TreeModel& model)
        : forces(model.joints.size()), levers(model.joints.size()), own(model.joints.size()), accelerations(model.joints.size()) {}
    JointRoom<SpatialForce<T>> forces;                ///< in: needed to move each joint's body as it is, less loads; out: what each joint transmits
    JointRoom<Vec3<T>> levers;                        ///< of a rod: the moment of what it carries is x x lever
    JointRoom<Vec3<T>> own;                           ///< its answer before its parent moves, a rod's in its own frame
    JointRoom<SpatialAcceleration<T>> accelerations;  ///< of each joint's body
  };

  /// Solves for the free coordinates' accelerations with the matrices of factor().
  /// @param tau  generalised force on each coordinate
  /// @param qdd  one a coordinate, of which free ones are written; or NotWanted
  /// @param rods  one a joint: motion of rods whose angular acceleration is counted from zero, and whose forces lack the moments x x lever; null:
  ///              their accelerations, too, add to those of their frames, and their forces are whole. Of several directions: of the first one
  template <typename T, typename Tau, typename Qdd>
  RPSUP_INLINE void solve(const JointAxes* axes, const Tau& tau, Scratch<T>& scratch, const Qdd& qdd, const RodMotion* rods = nullptr) const {
    Shapes::inwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      SpatialForce<T>& force = scratch.forces[i];
      if (joint.is_rod) {
        Vec3<T> lever;
        if (joint.carries_moving) lever = scratch.levers[i];
        if (rods) lever = lever + as_first<T>(rods[i].lever);
        transmit_rod(axes[i], eliminated_[i].rod, tau + joint.first, lever, scratch.own[i], force);
      } else if (!joint.driven) {
        transmit(joint, axes[i], eliminated_[i], tau + joint.first, scratch.own[i], force);
      }
      if (joint.parent < 0) return;
      const auto p = static_cast<std::size_t>(joint.parent);
      SpatialForce<T>& parent = scratch.forces[p];
      parent.force += force.force;
      if (joint.parent_is_rod) {
        scratch.levers[p] = joint.numbers().placement.p[0] * force.force;
        parent.moment += force.moment;
      } else if (joint.parent_turns) {
        parent.moment += force.moment + cross(axes[i].r, force.force);
      }
    });
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.moves) accelerate(joint, i, axes[i], scratch, qdd + joint.first, rods);
    });
  }

  /// The same in several directions at once. Much code, which several call: not inlined into each of them.
  [[gnu::noinline]] void solve_lanes(const JointAxes* axes, const Directions* tau, Scratch<Directions>& scratch, Directions* qdd) const {
    solve(axes, tau, scratch, qdd);
  }
  /// The bodies' accelerations alone, by forces on bodies; in the first direction by a motion's generalised forces and rods, too.
  [[gnu::noinline]] void solve_bodies_lanes(const JointAxes* axes, const double* tau, Scratch<Directions>& scratch, const RodMotion* rods) const {
    solve(axes, FirstForces{tau}, scratch, NotWanted<Directions>(), rods);
  }

  /// After solve(): the force or moment along the axis that the joint of a driven coordinate exerts.
  /// @param k  the joint's index
  template <typename Joint, typename T>
  [[nodiscard]] RPSUP_INLINE T calc_drive_force(const Joint& joint, std::size_t k, const JointAxes& axes, const Scratch<T>& scratch) const {
    SpatialForce<T> force = scratch.forces[k];
    if (joint.parent_moves) {
      const SpatialAcceleration<T>& a = scratch.accelerations[k];
      force.force += answers_[k].A * a.linear + answers_[k].C * a.angular;
      force.moment += transpose_times(answers_[k].C, a.linear) + answers_[k].J * a.angular;
    }
    return joint.rotates() ? dot(axes.axis[0], force.moment) : dot(axes.axis[0], force.force);
  }

 private:
  /// What a joint's body, and all that it carries, answers to an acceleration.
  struct Answer {
    Sym3<double> A;
    Mat3<double> C;
    Sym3<double> J;
    // Of a rod in the place of C and J:
    Sym3<double> carried;       ///< A of what it carries
    double reach = 0.0;         ///< how far along it
  };
  /// A rod turns about its own axis by itself: in its frame J^-1 = (1 / I_x), (a, b; b, d), and C x = 0.
  struct RodAnswer {
    Mat3<double> R;
    Vec3<double> C_J_y, C_J_z;  ///< columns y and z of C J^-1
    double a, b, d, I_x_inverse;
  };
  /// What eliminating a joint's coordinates left behind.
  struct Eliminated {
    Mat3<double> C;             ///< spherical
    Sym3<double> J_inverse;     ///< spherical
    RodAnswer rod;
    Vec3<double> U_a, U_alpha;  ///< single: force and moment of a unit acceleration of the coordinate
    double D_inverse;           ///< single
  };

  /// C of a body alone: alpha x mc.
  [[nodiscard]] RPSUP_INLINE static Mat3<double> cross_matrix(const Vec3<double>& mc) {
    return {{0.0, -mc.z, mc.y}, {mc.z, 0.0, -mc.x}, {-mc.y, mc.x, 0.0}};
  }

  /// Adds the body to what its children have left, or puts it there where none has.
  template <typename Joint>
  RPSUP_INLINE void add_body(const Joint& joint, const Mat3<double>& R, Answer& answer) const {
    if (!joint.carries_moving) answer = Answer{};
    answer.A.xx += joint.numbers().mass;
    answer.A.yy += joint.numbers().mass;
    answer.A.zz += joint.numbers().mass;
    if (!joint.answers_turning || joint.is_rod) return;
    if (!joint.com_at_origin) answer.C += cross_matrix(rotate_constant(R, joint.numbers().mc, joint.com_along_x));
    if (joint.inertia != JointShape::Inertia::kNone) answer.J += calc_inertia(joint, R);
  }

  template <typename Joint>
  RPSUP_INLINE bool eliminate(const Joint& joint, const Mat3<double>& R, Answer& answer, const Vec3<double>& axis, Eliminated& eliminated) const {
    if (joint.driven) return true;
    if (joint.kind != JointShape::Kind::kSpherical) return eliminate_single(joint, axis, answer, eliminated);
    if (joint.is_rod) return eliminate_rod(joint, R, answer, eliminated.rod);
    const Sym3Inverse<double> inverse = invert(answer.J);
    if (!(inverse.determinant > 0.0)) return false;
    eliminated.J_inverse = inverse.matrix;
    eliminated.C = answer.C;
    if (joint.parent_moves) subtract_turning(eliminated, answer.A);
    return true;
  }

  /// @returns whether its moments of inertia are positive definite
  template <typename Joint>
  RPSUP_INLINE bool eliminate_rod(const Joint& joint, const Mat3<double>& R, Answer& answer, RodAnswer& rod) const {
    rod.R = R;
    rod.I_x_inverse = 1.0 / joint.numbers().I[0];
    const double determinant = joint.carries_moving ? eliminate_carrying_rod(joint, R, answer, rod) : eliminate_last_rod(joint, R, answer, rod);
    return determinant > 0.0 && joint.numbers().I[0] > 0.0;
  }

  /// With A_c of what the rod carries at l x, and B = mc + l A_c:  C y = -B z,  C z = B y,
  /// J_yy = I_y - l mc + l z B z,  J_zz = I_y - l mc + l y B y,  J_yz = -l z B y.
  template <typename Joint>
  RPSUP_INLINE double eliminate_carrying_rod(const Joint& joint, const Mat3<double>& R, Answer& answer, RodAnswer& rod) const {
    const double mc = joint.numbers().mc[0], l = answer.reach;
    Sym3<double> B = l * answer.carried;
    B.xx += mc;
    B.yy += mc;
    B.zz += mc;
    const Vec3<double> B_y = B * R.y, B_z = B * R.z;
    const double beyond_B = joint.numbers().I[4] - l * mc;
    const double J_yy = beyond_B + l * dot(R.z, B_z), J_zz = beyond_B + l * dot(R.y, B_y), minus_J_yz = l * dot(R.z, B_y);
    const double determinant = J_yy * J_zz - minus_J_yz * minus_J_yz;
    const double inverse = 1.0 / determinant;
    rod.a = inverse * J_zz;
    rod.b = inverse * minus_J_yz;
    rod.d = inverse * J_yy;
    rod.C_J_y = rod.b * B_y - rod.a * B_z;
    rod.C_J_z = rod.d * B_y - rod.b * B_z;
    if (joint.parent_moves) {
      add_half_outer(answer.A, rod.C_J_y, B_z);
      add_half_outer(answer.A, -rod.C_J_z, B_y);
    }
    return determinant;
  }

  /// A rod that carries nothing: C y = -mc z,  C z = mc y,  J_yy = J_zz = I_y.
  template <typename Joint>
  RPSUP_INLINE double eliminate_last_rod(const Joint& joint, const Mat3<double>& R, Answer& answer, RodAnswer& rod) const {
    const double mc = joint.numbers().mc[0], I_y = joint.numbers().I[4];
    rod.a = rod.d = 1.0 / I_y;
    rod.b = 0.0;
    const double scaled = mc * rod.a;
    rod.C_J_y = -scaled * R.z;
    rod.C_J_z = scaled * R.y;
    if (joint.parent_moves) {  // y y^T + z z^T = 1 - x x^T
      const double across = mc * scaled;
      answer.A.xx -= across;
      answer.A.yy -= across;
      answer.A.zz -= across;
      add_outer(answer.A, across, R.x);
    }
    return I_y;
  }

  /// A <- A - C J^-1 C^T: all three rotations at once, whatever their axes.
  RPSUP_INLINE void subtract_turning(const Eliminated& e, Sym3<double>& A) const {
    const Vec3<double> row_x{e.C.x.x, e.C.y.x, e.C.z.x}, row_y{e.C.x.y, e.C.y.y, e.C.z.y}, row_z{e.C.x.z, e.C.y.z, e.C.z.z};
    const Vec3<double> x = e.J_inverse * row_x, y = e.J_inverse * row_y, z = e.J_inverse * row_z;
    A.xx -= dot(row_x, x);
    A.yy -= dot(row_y, y);
    A.zz -= dot(row_z, z);
    A.xy -= dot(row_x, y);
    A.xz -= dot(row_x, z);
    A.yz -= dot(row_y, z);
  }

  template <typename Joint>
  RPSUP_INLINE bool eliminate_single(const Joint& joint, const Vec3<double>& axis, Answer& answer, Eliminated& e) const {
    if (joint.rotates()) {
      e.U_a = answer.C * axis;
      e.U_alpha = answer.J * axis;
    } else {
      e.U_a = answer.A * axis;
      if (joint.answers_turning) e.U_alpha = transpose_times(answer.C, axis);
    }
    const double D = joint.rotates() ? dot(axis, e.U_alpha) : dot(axis, e.U_a);
    e.D_inverse = 1.0 / D;
    if (joint.parent_moves) {
      const double minus = -e.D_inverse;
      add_outer(answer.A, minus, e.U_a);
      if (joint.parent_answers_turning) {
        add_outer(answer.J, minus, e.U_alpha);
        const Vec3<double> scaled = minus * e.U_a;
        answer.C += Mat3<double>{e.U_alpha.x * scaled, e.U_alpha.y * scaled, e.U_alpha.z * scaled};
      }
    }
    return D > 0.0;
  }

  /// Adds what is left of a joint to its parent, whose origin sees the joint's at r.
  template <typename Joint>
  RPSUP_INLINE void carry(const Joint& joint, const Answer& answer, const Vec3<double>& r, Answer& parent) {
    if (joint.last_child) parent = Answer{};
    parent.A += answer.A;
    if (joint.parent_is_rod) {
      parent.carried = answer.A;
      parent.reach = joint.numbers().placement.p[0];
      return;
    }
    if (!joint.parent_answers_turning) return;
    const Mat3<double> B = times_cross(answer.A, r);
    parent.C.x -= B.x;
    parent.C.y -= B.y;
    parent.C.z -= B.z;
    subtract_cross(r, B, parent.J);
    if (joint.kind == JointShape::Kind::kSpherical) return;
    parent.C += answer.C;
    parent.J += answer.J;
    add_cross_both(r, answer.C, parent.J);
  }

  /// A [r]x
  [[nodiscard]] RPSUP_INLINE static Mat3<double> times_cross(const Sym3<double>& A, const Vec3<double>& r) {
    return {{A.xy * r.z - A.xz * r.y, A.yy * r.z - A.yz * r.y, A.yz * r.z - A.zz * r.y},
            {A.xz * r.x - A.xx * r.z, A.yz * r.x - A.xy * r.z, A.zz * r.x - A.xz * r.z},
            {A.xx * r.y - A.xy * r.x, A.xy * r.y - A.yy * r.x, A.xz * r.y - A.yz * r.x}};
  }

  /// J <- J - [r]x B, which is symmetric.
  RPSUP_INLINE static void subtract_cross(const Vec3<double>& r, const Mat3<double>& B, Sym3<double>& J) {
    J.xx -= r.y * B.x.z - r.z * B.x.y;
    J.yy -= r.z * B.y.x - r.x * B.y.z;
    J.zz -= r.x * B.z.y - r.y * B.z.x;
    J.xy -= r.y * B.y.z - r.z * B.y.y;
    J.xz -= r.y * B.z.z - r.z * B.z.y;
    J.yz -= r.z * B.z.x - r.x * B.z.z;
  }

  /// J <- J + [r]x C + its transpose
  RPSUP_INLINE static void add_cross_both(const Vec3<double>& r, const Mat3<double>& C, Sym3<double>& J) {
    const Vec3<double> x = cross(r, C.x), y = cross(r, C.y), z = cross(r, C.z);
    J.xx += 2.0 * x.x;
    J.yy += 2.0 * y.y;
    J.zz += 2.0 * z.z;
    J.xy += y.x + x.y;
    J.xz += z.x + x.z;
    J.yz += z.y + y.z;
  }

  /// @param lever  the force needed has the moment x x lever beside its own
  template <typename T, typename Tau>
  RPSUP_INLINE void transmit_rod(const JointAxes& axes, const RodAnswer& rod, const Tau& tau, const Vec3<T>& lever, Vec3<T>& own,
                                 SpatialForce<T>& force) const {
    const Vec3<T> moment = tau[0] * axes.dual.x + tau[1] * axes.dual.y + tau[2] * axes.dual.z;
    Vec3<T> n = transpose_times(rod.R, moment - force.moment);
    n.y += dot(rod.R.z, lever);
    n.z -= dot(rod.R.y, lever);
    own = {rod.I_x_inverse * n.x, rod.a * n.y + rod.b * n.z, rod.b * n.y + rod.d * n.z};
    force.force += n.y * rod.C_J_y + n.z * rod.C_J_z;
    force.moment = moment;
  }

  /// The force and moment that a joint passes on before its parent accelerates.
  template <typename Joint, typename T, typename Tau>
  RPSUP_INLINE void transmit(const Joint& joint, const JointAxes& axes, const Eliminated& e, const Tau& tau, Vec3<T>& own,
                             SpatialForce<T>& force) const {
    if (joint.kind == JointShape::Kind::kSpherical) {
      const Vec3<T> moment = tau[0] * axes.dual.x + tau[1] * axes.dual.y + tau[2] * axes.dual.z;
      own = e.J_inverse * (moment - force.moment);
      force.force += e.C * own;
      force.moment = moment;
      return;
    }
    own.x = e.D_inverse * (tau[0] - (joint.rotates() ? dot(axes.axis[0], force.moment) : dot(axes.axis[0], force.force)));
    force.force += own.x * e.U_a;
    if (joint.answers_turning) force.moment += own.x * e.U_alpha;
  }

  /// A joint's acceleration, after its parent's.
  template <typename Joint, typename T, typename Qdd>
  RPSUP_INLINE void accelerate(const Joint& joint, std::size_t k, const JointAxes& axes, Scratch<T>& scratch, const Qdd& qdd,
                               const RodMotion* rods) const {
    constexpr bool wanted = !std::is_same_v<Qdd, NotWanted<T>>;
    const Eliminated& e = eliminated_[k];
    SpatialAcceleration<T> own;
    if (joint.parent_moves) {
      own = scratch.accelerations[static_cast<std::size_t>(joint.parent)];
      if (joint.parent_answers_turning) own.linear += cross(own.angular, axes.r);
    }
    if (joint.kind == JointShape::Kind::kSpherical) {
      Vec3<T> alpha = scratch.own[k];
      if (joint.is_rod) {
        if (joint.parent_moves) {
          alpha.y -= dot(e.rod.C_J_y, own.linear);
          alpha.z -= dot(e.rod.C_J_z, own.linear);
        }
        alpha = e.rod.R * alpha;
      } else if (joint.parent_moves) {
        alpha -= e.J_inverse * transpose_times(e.C, own.linear);
      }
      if constexpr (wanted) find_rotations(axes, alpha - own.angular, rods && joint.is_rod ? &rods[k] : nullptr, qdd);
      own.angular = alpha;
    } else if (!joint.driven) {
      T acceleration = scratch.own[k].x;
      if (joint.parent_moves) {
        acceleration -= e.D_inverse * dot(e.U_a, own.linear);
        if (joint.parent_answers_turning) acceleration -= e.D_inverse * dot(e.U_alpha, own.angular);
      }
      if constexpr (wanted) qdd[0] = acceleration;
      if (joint.rotates())
        own.angular += acceleration * axes.axis[0];
      else
        own.linear += acceleration * axes.axis[0];
    }
    if (joint.carries_moving || joint.driven || Shapes::have_rows) scratch.accelerations[k] = own;
  }

  /// Accelerations of a spherical joint's coordinates. @param rod  its motion if its angular acceleration is counted from zero, else null
  template <typename T, typename Qdd>
  RPSUP_INLINE static void find_rotations(const JointAxes& axes, Vec3<T> relative, const RodMotion* rod, const Qdd& qdd) {
    if (rod) relative = relative - rod->wd_carried;
    qdd[0] = dot(axes.dual.x, relative);
    qdd[1] = dot(axes.dual.y, relative);
    qdd[2] = dot(axes.dual.z, relative);
    if (!rod) return;
    qdd[0] = rod->qdd_turning[0] + qdd[0];
    qdd[1] = rod->qdd_turning[1] + qdd[1];
    qdd[2] = rod->qdd_turning[2] + qdd[2];
  }

  const TreeModel& model_;
  JointRoom<Answer> answers_;
  JointRoom<Eliminated> eliminated_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
