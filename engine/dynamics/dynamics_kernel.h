// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "engine/clearance/clearance_joint.h"
#include "engine/dynamics/evaluation.h"
#include "engine/kinematics/tree_model.h"
#include "engine/model/drive_law.h"

namespace engine {

/// What came of an evaluation of the equations of motion.
enum class EvaluationStatus {
  kOk,
  kBristleMissing,  ///< an element touched that has no place in the state: widen_bristles() and step again
  kLocked,          ///< the constraints' matrix is singular
  kOutOfRange,      ///< a penetration beyond what the contact's stiffness law holds for
  kNonFinite,       ///< no number, or a mass matrix that is not positive definite
};

/// How the systems of an implicit step are solved: with a matrix of the free coordinates, whose cost grows with the third power of their number, or
/// body by body, which takes no constraints and no springs between points.
enum class Elimination { kMatrix, kBodies };

/// The equations of motion, compiled for one instruction set: one call evaluates everything.
class Equations {
 public:
  virtual ~Equations() = default;
  Equations(const Equations&) = delete;
  Equations& operator=(const Equations&) = delete;

  /// @param y      state as MotionSystem describes it
  /// @param drives        motion of each drive at the time of y
  /// @param drives_moved  whether it is another one than in the last call
  [[nodiscard]] virtual EvaluationStatus evaluate(const double* y, const DrivenMotion* drives, bool drives_moved, double* dydt) = 0;
  /// The same, and keeps all that it finds on the way.
  [[nodiscard]] virtual EvaluationStatus evaluate_and_keep(const double* y, const DrivenMotion* drives, bool drives_moved, double* dydt) = 0;

  /// What evaluate_and_keep() last found, for observers.
  virtual void read_out(Evaluation& at) const = 0;

  /// Whether the systems of an implicit step can be solved body by body.
  [[nodiscard]] virtual bool can_solve_by_bodies() const = 0;

  /// Computes the Jacobian J of MotionSystem's state equation, or what solving body by body needs of it, where evaluate_and_keep() was last called,
  /// and came to an end: at the same y and motion of the drives. Exact to rounding.
  /// @param by_t  out: df/dt
  virtual void linearise(const double* y, const DrivenMotion* drives, Elimination elimination, double* by_t) = 0;
  /// Factors (shift 1 - J). False if it is singular. There is room for one real and one complex shift.
  [[nodiscard]] virtual bool factor(double shift) = 0;
  [[nodiscard]] virtual bool factor(double real, double imag) = 0;
  /// x <- (shift 1 - J)^-1 x after factor() of such a shift; of a complex one by its parts.
  virtual void solve(double* x) = 0;
  virtual void solve(double* real, double* imag) = 0;

 protected:
  Equations() = default;
};

/// Names of the instruction sets that this program was compiled for and this machine has; the best one is last. None if the
/// program was compiled for others alone (RPSUP_INSTRUCTION_SETS).
[[nodiscard]] std::vector<std::string_view> instruction_sets();

/// @param instruction_set  one of instruction_sets(); results are the same to the last bit
/// @param model, joints    must outlive the equations; `joints` are the mechanism's joints with clearance, with what they remember
[[nodiscard]] std::unique_ptr<Equations> make_equations(std::string_view instruction_set, const TreeModel& model,
                                                        const std::vector<ClearanceJoint>& joints);

}  // namespace engine
