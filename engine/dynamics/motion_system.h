// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "engine/clearance/clearance_joint.h"
#include "engine/dynamics/applied_forces.h"
#include "engine/dynamics/dynamics_kernel.h"
#include "engine/dynamics/evaluation.h"
#include "engine/dynamics/reaction_friction.h"
#include "engine/dynamics/state_layout.h"
#include "engine/kinematics/tree_model.h"
#include "engine/model/drive_piece.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Shifts with which (shift 1 - J) is factored.
enum class Shifts { kReal, kRealAndComplex };

/// The mechanism as a first-order system dy/dt = f(t, y), Eqs. (13.1) and (13.2).
///
/// StateLayout says what y is. f depends on which contacts are on: that memory changes between steps only, by
/// accept_step().
class MotionSystem {
 public:
  /// @param instruction_set  one of instruction_sets(), the best one if empty; results are the same to the
  /// last bit
  explicit MotionSystem(const Mechanism& mechanism, std::string_view instruction_set = {});
  MotionSystem(const MotionSystem&) = delete;
  MotionSystem& operator=(const MotionSystem&) = delete;

  /// Takes note of placements that have changed in the mechanism.
  void reload_mechanism();

  /// Evaluates the drives inside this piece from now on; before the first call at any t.
  void follow_drives(const DrivePiece& piece);

  /// State at t = 0 for given coordinates (of all the mechanism).
  [[nodiscard]] Eigen::VectorXd make_state(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) const;
  /// An Evaluation of the right sizes, so that evaluating allocates nothing.
  [[nodiscard]] Evaluation make_evaluation() const;

  /// Computes dy/dt. Allocates nothing.
  [[nodiscard]] EvaluationStatus calc_derivative(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt);
  /// Computes dy/dt, and all intermediate results. Allocates nothing.
  [[nodiscard]] EvaluationStatus calc_derivative(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt,
                                                 Evaluation& at);

  /// Computes the Jacobian J = df/dy, or the operating point that the recursive solver needs instead, and
  /// df/dt at (t, y), with the contacts as they are. All is valid until the next call. The Jacobian is exact
  /// but for the normal force of friction by reaction, which counts as constant.
  [[nodiscard]] EvaluationStatus linearise(double t, const Eigen::VectorXd& y,
                                           NewtonSolver newton_solver = NewtonSolver::kDense);
  /// The cheaper solver for this mechanism.
  [[nodiscard]] NewtonSolver choose_newton_solver(Shifts shifts) const;
  [[nodiscard]] bool can_solve_recursively() const { return kernel_->can_solve_recursively(); }
  /// df/dt of the last linearise(), one for each entry of y.
  [[nodiscard]] const Eigen::VectorXd& time_derivative() const { return time_derivative_; }
  /// Factors (shift 1 - J). False if it is singular. One real and one complex shift can be factored at a
  /// time.
  [[nodiscard]] bool factor(double shift) { return kernel_->factor(shift); }
  [[nodiscard]] bool factor(std::complex<double> shift) {
    return kernel_->factor(shift.real(), shift.imag());
  }
  /// x <- (shift 1 - J)^-1 x after factor() of such a shift.
  void solve_in_place(Eigen::VectorXd& x) { kernel_->solve(x.data()); }
  /// The same of a complex x, by its parts.
  void solve_in_place(Eigen::VectorXd& real, Eigen::VectorXd& imag) {
    kernel_->solve(real.data(), imag.data());
  }

  /// Kinetic and potential energy of an evaluation.
  void calc_energies(Evaluation& at) const;

  [[nodiscard]] const StateLayout& layout() const { return layout_; }
  /// Entries of y whose errors are controlled: all but works.
  [[nodiscard]] Eigen::Index controlled_size() const { return layout_.controlled_size(); }
  /// Weights of their errors in the root mean square of all; the squares of the weights sum to 1. A bristle
  /// of a contact element counts less than one of a continuum: more elements, or more bristles in reserve,
  /// would else allow larger errors of the coordinates.
  [[nodiscard]] const Eigen::VectorXd& error_weights() const { return error_weights_; }
  [[nodiscard]] Eigen::Index free_count() const { return layout_.free; }
  [[nodiscard]] const std::vector<FrameIndex>& free_coordinates() const { return model_.free; }

  /// Appends the penetration of every ring of every joint with clearance.
  void add_penetrations(const Evaluation& at, std::vector<Penetration>& rings) const;
  /// Lets bristles follow their contacts, before a step of dt. @returns true if any changed its index in y
  [[nodiscard]] bool prepare_step(const Evaluation& at, double dt, Eigen::VectorXd& y);
  /// Takes note of the contacts that began or ended in a step; f is another one if any did.
  [[nodiscard]] ContactChange accept_step(const Evaluation& start, const Evaluation& end, Eigen::VectorXd& y);
  /// Adds half as many bristles again to y.
  void widen_bristles(Eigen::VectorXd& y);

 private:
  /// The drives at the last instants: an implicit step comes back to each of its stages.
  struct DrivesAt {
    double t = std::numeric_limits<double>::quiet_NaN();  ///< [s]; no number: not yet computed
    std::vector<DrivenMotion> motion;
  };

  [[nodiscard]] bool move_drives(double t);
  [[nodiscard]] const DrivesAt& drives() const { return last_drives_[present_]; }
  void forget_drives();
  /// Computes dy/dt; the kernel keeps its solution.
  [[nodiscard]] EvaluationStatus solve(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt);
  [[nodiscard]] EvaluationStatus solve_friction(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt);
  void calc_applied_forces(double t, const Eigen::VectorXd& y);
  void add_clearance_joints();
  void allocate();
  void set_error_weights();

  const Mechanism& mechanism_;
  TreeModel model_;
  std::string_view instruction_set_;
  std::vector<ClearanceJoint> clearance_joints_;
  std::vector<std::size_t> clearance_joint_of_;  ///< index into cut_joints
  StateLayout layout_;
  Eigen::VectorXd error_weights_;
  AppliedForces applied_forces_;
  ReactionFriction reaction_friction_;
  Evaluation friction_at_;  ///< for solve_friction()

  std::array<DrivesAt, 4> last_drives_;
  std::size_t present_ = 0;  ///< of last_drives_: of the last evaluation
  std::size_t newest_ = 0;   ///< of last_drives_: of the last instant that was new
  DrivePiece piece_;
  std::unique_ptr<DynamicsKernel> kernel_;
  /// the kernel holds the solution at (drives().t, solved_y_), with the contacts as they are
  bool solved_ = false;
  Eigen::VectorXd solved_y_;
  Eigen::VectorXd dydt_;       ///< for linearise()
  Eigen::VectorXd time_derivative_;
};

}  // namespace engine
