#pragma once

#include "engine/dynamics/constraint_rows.h"
#include "engine/dynamics/multiplier_matrix.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The constraints of closed loops and enforced drives, solved for their multipliers.
/// @tparam Bodies  ArticulatedBodies
template <typename Bodies>
struct LoopEquations {
  explicit LoopEquations(const TreeModel& model)
      : rows(model),
        lambda(static_cast<std::size_t>(model.rows), static_cast<std::size_t>(rows.groups() * ConstraintRows::kSide)),
        responses(static_cast<std::size_t>(model.coordinates)),
        bodies_scratch(model),
        violations(model.cut_joints.size()),
        matrix(model),
        scratch(model) {}

  ConstraintRows rows;
  Buffer<double> lambda;                        ///< the rows' multipliers
  Buffer<Directions> responses;                 ///< M^-1 Phi_q^T of a group of rows
  typename Bodies::template Scratch<Directions> bodies_scratch;
  Buffer<JointViolation<double, double>> violations;  ///< one a cut joint; of ideal ones
  MultiplierMatrix matrix;                      ///< factored
  MultiplierMatrix::Scratch<double> scratch;
};
/// There are none.
struct NoLoops {
  RPSUP_INLINE explicit NoLoops(const TreeModel&) {}
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
