// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "engine/clearance/clearance_joint.h"
#include "engine/dynamics/kernel/forward/loss_powers.h"
#include "engine/dynamics/kernel/newton/contact_update.h"
#include "engine/dynamics/kernel/newton/tree_recursion.h"
#include "engine/dynamics/kernel/tangent/operating_point.h"
#include "engine/dynamics/state_layout.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/complex.h"
#include "engine/math/number_rows.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// @returns whether RecursiveNewtonSolver can solve a mechanism's Newton systems: it knows no constraints,
/// point springs, applied forces, body loads or armatures
[[nodiscard]] inline bool fits_recursive_solver(const TreeModel& model) {
  const bool has_armature = std::ranges::any_of(
      model.joints, [](const TreeJoint& joint) { return joint.armature != 0.0; });
  return model.rows == 0 && model.springs.empty() && model.applied_forces.empty() &&
         model.body_loads.empty() && !has_armature;
}

/// The Newton system (sigma 1 - J) x = b of an implicit step, J = df/dy of MotionSystem's state equation,
/// solved in O(n) for n bodies and bristles, and O(c n) and O((12 c)^3) for c joints in contact:
/// TreeRecursion for the open chains, ContactUpdate for the contacts. J is not assembled. NewtonMatrix solves
/// the same system with a dense matrix.
/// @tparam Scalar  double or Complex<double>, as the shift sigma is
template <typename Scalar>
class RecursiveNewtonSolver {
 public:
  /// @param model, joints  must outlive this
  RecursiveNewtonSolver(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                        const StateLayout& layout);

  void set_operating_point(const OperatingPointView& point);

  /// False if (sigma 1 - J) is singular.
  [[nodiscard]] bool factor(const Scalar& shift);
  /// x <- (sigma 1 - J)^-1 x. @param x  a state, laid out as StateLayout says
  void solve_in_place(NumbersAt<Scalar> x);

 private:
  void write_state(const LossPowers<Scalar>& losses, NumbersAt<Scalar> x) const;

  const TreeModel& model_;
  StateLayout layout_;
  Scalar inverse_shift_{1.0};
  Buffer<double> drive_rates_;
  TreeRecursion<Scalar> tree_;
  ContactUpdate<Scalar> contacts_;
  typename TreeRecursion<Scalar>::template Workspace<Scalar> work_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
