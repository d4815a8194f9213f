// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/constraints.h"
#include "engine/dynamics/evaluation.h"
#include "engine/dynamics/inverse_dynamics.h"
#include "engine/math/dense_matrix.h"
#include "engine/model/drive_piece.h"
#include "engine/model/mechanism.h"

namespace engine {

/// The mechanism with every cut joint ideal, every driven coordinate given and every spring at rest: pure geometry.
class LoopClosure {
 public:
  explicit LoopClosure(const Mechanism& mechanism);

  /// True if the drives alone decide the motion: as many constraint rows as unknown coordinates, and no spring.
  [[nodiscard]] bool is_determined() const;

  /// Evaluates the drives inside this piece from now on; before the first call at any t.
  void follow_drives(const DrivePiece& piece) { piece_ = piece; }

  /// The coordinates that the loops decide.
  [[nodiscard]] const std::vector<FrameIndex>& unknown_coordinates() const { return unknown_; }

  /// Closes the loops at time t by Newton's method from each coordinate's assembly_guess, or with it held at its start, and solves for the
  /// velocities that are not given.
  /// @returns false if they do not close; residual() then says by how much; or if the given velocities tear them apart: see rates_fit()
  [[nodiscard]] bool assemble(double t, Evaluation& at);

  /// After assemble(): whether the velocities given for the start go with the loops.
  [[nodiscard]] bool rates_fit() const { return rates_fit_; }
  /// Just after assemble(): whether the loops let drives begin that soon move from rest. They do not if the drives move against each other, or
  /// against a joint.
  [[nodiscard]] bool lets_drives_begin(const Evaluation& assembled);
  /// After assemble(): how many of the constraint rows (joints with clearance have none) follow from the others.
  [[nodiscard]] Eigen::Index redundant() const { return redundant_; }

  /// Sets the motion of `at`, but for the driven coordinates, to where that of two instants, the second one nearby, leads at time t: what
  /// solve() may start from. `at` may be one of them. If the first is not before the second, or t far from both, that is the second's motion.
  void lead(double t, const Evaluation& before, const Evaluation& nearby, Evaluation& at) const;

  /// Position, velocity, acceleration, joint reactions and drive forces at time t of a determined mechanism: solve_motion, then solve_forces.
  [[nodiscard]] bool solve(double t, Evaluation& at);

  /// Position, velocity and acceleration at time t of a determined mechanism. Starts from where the motion that `at` holds leads in the
  /// time from at.t to t; no more of it than q, qd, qdd and t is read. Allocates nothing.
  /// @returns false if the loops do not close near there: the mechanism locks, or `at` is too far away. Its q, qd and qdd are then of no use
  [[nodiscard]] bool solve_motion(double t, Evaluation& at);

  /// Joint reactions and drive forces of the motion that solve_motion found last, and the frames' motions. Allocates nothing.
  void solve_forces(Evaluation& at);

  /// Determinant of Phi_q of the unknown coordinates at the position that solve_motion found last, see keeps_branch.
  [[nodiscard]] double determinant() const { return J_.determinant(); }

  /// Largest entry of Phi after the last attempt, [m] or [1].
  [[nodiscard]] double residual() const { return constraints_.Phi.size() ? constraints_.Phi.cwiseAbs().maxCoeff() : 0.0; }

 private:
  [[nodiscard]] bool assemble_rates(Evaluation& at);
  [[nodiscard]] bool find_rates(const std::vector<Eigen::Index>& rows, Evaluation& at);
  [[nodiscard]] bool is_free(const Eigen::VectorXd& way) const;
  [[nodiscard]] bool closes_beside(const Eigen::VectorXd& q);
  [[nodiscard]] Eigen::VectorXd follow(const Eigen::VectorXd& gaps) const;
  [[nodiscard]] Eigen::MatrixXd calc_columns(const std::vector<FrameIndex>& coordinates) const;
  void predict(double t, Evaluation& at) const;
  void set_drives(double t, Evaluation& at) const;
  void calc_positions(Evaluation& at);
  void calc_rates(Evaluation& at);
  [[nodiscard]] bool close_position(Evaluation& at);
  void solve_rates(Evaluation& at);
  void take_step(Eigen::VectorXd& coordinates);
  [[nodiscard]] bool factor();

  Mechanism ideal_;
  std::vector<FrameIndex> unknown_;
  Constraints constraints_;
  InverseDynamics inverse_dynamics_;
  DrivePiece piece_;
  std::vector<Eigen::Index> rigid_rows_;  ///< those of joints without clearance, and of couplings
  Eigen::Index redundant_ = 0;
  bool rates_fit_ = true;
  DenseMatrix<double> J_;  ///< of a determined mechanism: Phi_q of the unknown coordinates, factored
  Eigen::VectorXd step_;  ///< of the unknown coordinates, or what it does to the rows
};

/// True if a step between positions with these determinants cannot have led from one way of closing the loops to another. The two ways
/// meet where the determinant vanishes, and where it stays away from zero by more than it changes they do not. Its sign alone does not
/// tell: that of a flat linkage vanishes as a square.
[[nodiscard]] inline bool keeps_branch(double from, double to) {
  const double ratio = to / from;
  return ratio > 1.0 / 3.0 && ratio < 3.0;
}

}  // namespace engine
