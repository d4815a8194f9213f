// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/constraints.h"
#include "engine/dynamics/evaluation.h"
#include "engine/dynamics/inverse_dynamics.h"
#include "engine/math/dense_matrix.h"
#include "engine/model/drive_piece.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Position, velocity and acceleration of a mechanism whose cut joints are ideal, whose driven coordinates
/// are given, and whose springs are unloaded: the constraints Phi(q) = 0 alone. The loops are closed by
/// Newton's method.
class LoopClosure {
 public:
  explicit LoopClosure(const Mechanism& mechanism);

  /// Part of the motion that the drives determine.
  enum class Determinacy {
    kFree,           ///< coordinates or springs are left to dynamics, or constraints are redundant
    kDetermined,     ///< as many active rows as unknown coordinates, and no spring, damper or load
    kSingularStart,  ///< the drives determine the motion elsewhere, but start in a change point
  };
  [[nodiscard]] Determinacy find_determinacy(const Evaluation& assembled);

  /// Start of a mechanism that the drives do not determine, by its rigid joints: the cut joints without
  /// clearance.
  enum class Start {
    kRegular,
    kContradiction,  ///< no accelerations satisfy constraints and drives
    kChangePoint,    ///< no accelerations, or rest, where rows do not bind that bind near by
    kImmovable,      ///< rest where constraints leave velocities, but no motion: a chain stretched taut, say
  };
  [[nodiscard]] Start find_start(const Evaluation& assembled);

  /// Evaluates the drives inside this piece from now on; before the first call at any t.
  void follow_drives(const DrivePiece& piece) { piece_ = piece; }

  /// The coordinates that the constraints determine.
  [[nodiscard]] const std::vector<FrameIndex>& unknown_coordinates() const { return unknown_; }

  /// Closes the loops at time t by Newton's method from each coordinate's assembly_guess, or with the
  /// coordinate fixed at its start, and solves for the velocities that are not given.
  /// Joints with clearance are closed at the centres of their bearings, unless given coordinates keep them
  /// off: anywhere in the bore then.
  /// @returns false if the loops do not close (residual() says by how much), if they close only with a joint
  /// turned over (see turned_over_joint()), or if the given velocities violate the constraints (see
  /// rates_fit())
  [[nodiscard]] bool assemble(double t, Evaluation& at);

  /// After assemble(): the cut joint that closes only a half turn off; -1: none.
  [[nodiscard]] int turned_over_joint() const { return turned_over_; }
  /// After assemble(): whether the velocities given for the start satisfy the constraints.
  [[nodiscard]] bool rates_fit() const { return rates_fit_; }
  /// Just after assemble(): whether drives that soon move from rest can start. They cannot if they move
  /// against each other, or against a joint.
  [[nodiscard]] bool drives_can_start(const Evaluation& assembled);
  /// Number of independent constraint rows in an assembled position. Joints with clearance have no rows.
  [[nodiscard]] Eigen::Index count_independent(const Evaluation& assembled);
  /// Number of the others.
  [[nodiscard]] Eigen::Index count_redundant(const Evaluation& assembled) {
    return static_cast<Eigen::Index>(rigid_rows_.size()) - count_independent(assembled);
  }

  /// Predictor for solve(): extrapolates the unknown coordinates of two instants to time t, by the quintic
  /// through their positions, velocities and accelerations. `at` may be one of the two instants. If `before`
  /// is not before `nearby`, or t is far from both, the motion is that of `nearby`.
  void extrapolate(double t, const Evaluation& before, const Evaluation& nearby, Evaluation& at) const;

  /// Position, velocity, acceleration, joint reactions and drive forces at time t of a determined mechanism:
  /// solve_motion, then solve_forces.
  [[nodiscard]] bool solve(double t, Evaluation& at);

  /// Position, velocity and acceleration at time t of a determined mechanism. Newton's method starts from the
  /// Taylor series of the motion that `at` holds, from at.t to t; only q, qd, qdd and t of `at` are read.
  /// Allocates nothing.
  /// @returns false if the loops do not close near there: the mechanism locks, or `at` is too far away. q, qd
  /// and qdd of `at` are invalid then
  [[nodiscard]] bool solve_motion(double t, Evaluation& at);

  /// Joint reactions, drive forces and motions of the frames for the last result of solve_motion. Allocates
  /// nothing.
  void solve_forces(Evaluation& at);

  /// Motion and forces at time t by those of two instants around it: the quintic of extrapolate(), and a
  /// straight line for forces; by the Taylor series if both are the same instant before t. For change points,
  /// where Phi_q is singular.
  void interpolate(double t, const Evaluation& before, const Evaluation& after, Evaluation& at) const;

  /// Determinant of Phi_q of the unknown coordinates at the last position of solve_motion, see keeps_branch.
  [[nodiscard]] double determinant() const { return J_.determinant(); }

  /// Largest entry of Phi after the last attempt, [m] or [1].
  [[nodiscard]] double residual() const {
    return constraints_.Phi.size() ? constraints_.Phi.cwiseAbs().maxCoeff() : 0.0;
  }

 private:
  void list_rigid_rows(const std::vector<CutJoint>& joints);
  void list_position_rows(const std::vector<CutJoint>& joints);
  void find_active_rows();
  void set_guess(double t, Evaluation& at) const;
  [[nodiscard]] bool close_from_guess(double t, Evaluation& at);
  [[nodiscard]] bool close_by_rotations(double t, Evaluation& at);
  [[nodiscard]] bool close_rigid_joints(Evaluation& at);
  [[nodiscard]] bool is_closed_but_for_rounding() const;
  [[nodiscard]] bool close(Evaluation& at, AxisResiduals axes, double tolerance,
                           const std::vector<Eigen::Index>& rows, const std::vector<FrameIndex>& moved);
  /// Largest entry of Phi that counts as zero, [m] and [1].
  [[nodiscard]] double closed() const;
  [[nodiscard]] bool is_left_to_drives() const;
  [[nodiscard]] bool is_determined_elsewhere(const Evaluation& assembled);
  [[nodiscard]] Eigen::Index calc_rank() const;
  [[nodiscard]] Eigen::MatrixXd calc_rigid_rows() const;
  [[nodiscard]] Eigen::VectorXd calc_row_weights() const;
  [[nodiscard]] Eigen::Index calc_binding_rank() const;
  [[nodiscard]] bool can_accelerate(const Evaluation& assembled);
  [[nodiscard]] bool assemble_rates(Evaluation& at);
  [[nodiscard]] bool find_rates(const std::vector<Eigen::Index>& rows, Evaluation& at);
  [[nodiscard]] bool is_free(const Eigen::VectorXd& displacement) const;
  [[nodiscard]] std::optional<Eigen::VectorXd> close_from_perturbed(Eigen::VectorXd q);
  [[nodiscard]] Eigen::VectorXd minimum_norm_correction(const Eigen::VectorXd& gaps) const;
  [[nodiscard]] Eigen::MatrixXd calc_columns(const std::vector<FrameIndex>& coordinates) const;
  [[nodiscard]] Eigen::MatrixXd calc_columns_above_noise(const std::vector<FrameIndex>& coordinates) const;
  void start_from_taylor_series(double t, Evaluation& at) const;
  void set_drives(double t, Evaluation& at) const;
  void calc_positions(Evaluation& at, AxisResiduals axes = AxisResiduals::kProducts);
  void calc_rates(Evaluation& at);
  [[nodiscard]] bool close_position(Evaluation& at);
  void solve_rates(Evaluation& at);
  void solve_multipliers(const Eigen::VectorXd& forces);
  void interpolate_coordinates(double s, const Evaluation& before, const Evaluation& after,
                               Evaluation& at) const;
  void extend_coordinates(double dt, const Evaluation& before, Evaluation& at) const;
  void take_active(const Eigen::Ref<const Eigen::VectorXd>& rows);
  void apply_newton_step(Eigen::VectorXd& coordinates);
  [[nodiscard]] bool factor();

  Mechanism ideal_;
  std::vector<FrameIndex> unknown_;
  Constraints constraints_;
  InverseDynamics inverse_dynamics_;
  DrivePiece piece_;
  std::vector<CutJoint> clearance_joints_;
  std::vector<Eigen::Index> all_rows_;    ///< all constraint rows
  std::vector<Eigen::Index> rigid_rows_;  ///< constraint rows of joints without clearance, and of couplings
  std::vector<Eigen::Index> blocks_;  ///< of each rigid row: rows of one joint's position, or of its axes
  std::vector<Eigen::Index> active_rows_;  ///< constraint rows that some coordinate moves
  std::vector<Eigen::Index> position_rows_;  ///< constraint rows that are distances
  double reach_ = 0.0;  ///< largest distance of a cut joint or a centre of mass from its frame's origin, [m]
  double size_ = 0.0;   ///< the same of the last position, from the origin of W
  bool rates_fit_ = true;
  int turned_over_ = -1;
  // Solver of a determined mechanism:
  DenseMatrix<double> J_;   ///< Phi_q of the active rows and the unknown coordinates, factored
  Eigen::VectorXd step_;    ///< residual of the active rows, then the Newton step of the unknown coordinates
  Eigen::VectorXd lambda_;  ///< multipliers of all rows
};

/// True if a step between positions with these determinants of Phi_q stays on one assembly branch. Two
/// branches meet where the determinant vanishes: the step stays on the branch if the determinant keeps its
/// sign and changes by a factor below 3. The sign alone does not tell, since the determinant of a flat
/// linkage vanishes as a square.
[[nodiscard]] inline bool keeps_branch(double from, double to) {
  const double ratio = to / from;
  return ratio > 1.0 / 3.0 && ratio < 3.0;
}

}  // namespace engine
