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

/// Outcome of an evaluation of the equations of motion.
enum class EvaluationStatus {
  kOk,
  /// a contact element touches that has no bristle in the state: widen_bristles() and repeat the step
  kBristleMissing,
  kLocked,          ///< the Delassus matrix is singular
  kOutOfRange,      ///< a penetration beyond what the contact's stiffness law holds for
  kWedged,          ///< no friction is found that fits the reactions that it makes
  kNonFinite,       ///< an infinity or a NaN, or a mass matrix that is not positive definite
};

/// Solver of the Newton systems of an implicit step: a dense matrix, O(n^3) for n free coordinates, or a
/// recursion over the bodies, O(n), for mechanisms without constraints, springs between points, applied
/// forces, loads on bodies and armatures.
enum class NewtonSolver { kDense, kRecursive };

/// The equations of motion, their linearisation and their Newton systems, compiled for one instruction set:
/// the door to engine/dynamics/kernel.
class DynamicsKernel {
 public:
  virtual ~DynamicsKernel() = default;
  DynamicsKernel(const DynamicsKernel&) = delete;
  DynamicsKernel& operator=(const DynamicsKernel&) = delete;

  /// @param y             state, laid out as StateLayout says
  /// @param drives        motion of each drive at the time of y
  /// @param drives_moved  whether it has changed since the last call
  [[nodiscard]] virtual EvaluationStatus evaluate(const double* y, const DrivenMotion* drives,
                                                  bool drives_moved, double* dydt) = 0;
  /// The same, and keeps all intermediate results.
  [[nodiscard]] virtual EvaluationStatus evaluate_and_keep(const double* y, const DrivenMotion* drives,
                                                           bool drives_moved, double* dydt) = 0;

  /// Reads out the results of the last evaluate_and_keep(), for observers.
  virtual void read_out(Evaluation& at) const = 0;

  /// @returns whether NewtonSolver::kRecursive can solve this mechanism's Newton systems
  [[nodiscard]] virtual bool can_solve_recursively() const = 0;

  /// Linearises at the y and drives of the last evaluate_and_keep(), which must have returned kOk: computes
  /// the Jacobian J = df/dy, exact to rounding, or for the recursive solver the operating point instead.
  /// @param by_t  out: df/dt
  virtual void linearise(const double* y, const DrivenMotion* drives, NewtonSolver newton_solver,
                         double* by_t) = 0;
  /// Factors (shift 1 - J). False if it is singular. One real and one complex shift can be factored at a
  /// time.
  [[nodiscard]] virtual bool factor(double shift) = 0;
  [[nodiscard]] virtual bool factor(double real, double imag) = 0;
  /// x <- (shift 1 - J)^-1 x after factor() of such a shift; of a complex one by its parts.
  virtual void solve(double* x) = 0;
  virtual void solve(double* real, double* imag) = 0;

 protected:
  DynamicsKernel() = default;
};

/// Names of the instruction sets that this program was compiled for and this machine has; the best one is
/// last. None if the program was compiled for others alone (RPSUP_INSTRUCTION_SETS).
[[nodiscard]] std::vector<std::string_view> instruction_sets();

/// @param instruction_set  one of instruction_sets(); results are the same to the last bit
/// @param model, joints    must outlive the kernel; `joints` are the mechanism's joints with clearance, with
/// their memory of contacts
[[nodiscard]] std::unique_ptr<DynamicsKernel> make_dynamics_kernel(std::string_view instruction_set,
                                                                   const TreeModel& model,
                                                                   const std::vector<ClearanceJoint>& joints,
                                                                   AppliedValues applied);

}  // namespace engine
