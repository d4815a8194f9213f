#pragma once

#include "engine/dynamics/constraint_rows.h"
#include "engine/dynamics/multiplier_matrix.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The constraints of closed loops and enforced drives, solved for their multipliers.
struct LoopEquations {
  explicit LoopEquations(const TreeModel& model)
      : rows(model),
        lambda(static_cast<std::size_t>(model.rows)),
        response(static_cast<std::size_t>(model.rows * model.coordinates)),
        violations(model.cut_joints.size()),
        matrix(model),
        scratch(model) {}

  ConstraintRows rows;
  Buffer<double> lambda;                        ///< the rows' multipliers
  Buffer<double> response;                      ///< M^-1 Phi_q^T, row after row of Phi
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
