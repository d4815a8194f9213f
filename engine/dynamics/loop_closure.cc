#include "engine/dynamics/loop_closure.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/QR>

namespace engine {

namespace {

constexpr double kClosed = 1e-13;  // of Phi, [m] and [1]: rounding of positions near 1 m
constexpr int kMaxIterations = 100;
constexpr double kMaxStep = 0.5;   // of one Newton step, [rad] or [m]: from a guess far away a full step may leave the branch

Mechanism make_ideal(Mechanism mechanism) {
  for (CutJoint& joint : mechanism.cut_joints) joint.clearance.reset();
  mechanism.drive_rows = DriveRows::kEliminated;
  return mechanism;
}

std::vector<FrameIndex> find_unknown_coordinates(const Mechanism& mechanism) {
  std::vector<FrameIndex> unknown;
  for (FrameIndex i = 0; i < static_cast<FrameIndex>(mechanism.coordinates.size()); ++i) {
    const bool driven = std::any_of(mechanism.drives.begin(), mechanism.drives.end(), [i](const Drive& d) { return d.coordinate == i; });
    if (!driven && mechanism.coordinates[static_cast<std::size_t>(i)].stiffness == 0.0) unknown.push_back(i);
  }
  return unknown;
}

}  // namespace

LoopClosure::LoopClosure(const Mechanism& mechanism)
    : ideal_(make_ideal(mechanism)), unknown_(find_unknown_coordinates(ideal_)), constraints_(ideal_), inverse_dynamics_(ideal_) {
  J_.setZero(constraints_.count(), static_cast<Eigen::Index>(unknown_.size()));
  step_.setZero(J_.cols());
  lambda_.setZero(J_.rows());
}

bool LoopClosure::is_determined() const {
  return constraints_.count() == static_cast<Eigen::Index>(unknown_.size()) &&
         unknown_.size() + ideal_.drives.size() == ideal_.coordinates.size();
}

void LoopClosure::set_drives(double t, Evaluation& at) const {
  at.t = t;
  for (const Drive& drive : ideal_.drives) {
    const DrivenMotion motion = calc_driven_motion(drive.law, t);
    at.q[drive.coordinate] = motion.q;
    at.qd[drive.coordinate] = motion.qd;
    at.qdd[drive.coordinate] = motion.qdd;
  }
}

void LoopClosure::calc_rows(Evaluation& at) {
  calc_frame_motions(ideal_, at.q, at.qd, at.qdd, at.frames);
  constraints_.calc(at.frames);
  for (std::size_t k = 0; k < unknown_.size(); ++k) J_.col(static_cast<Eigen::Index>(k)) = constraints_.Phi_q.col(unknown_[k]);
}

bool LoopClosure::assemble(double t, Evaluation& at) {
  at.q.setZero();
  at.qd.setZero();
  at.qdd.setZero();
  for (const FrameIndex i : unknown_) at.q[i] = ideal_.coordinates[static_cast<std::size_t>(i)].assembly_guess;
  set_drives(t, at);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    calc_rows(at);
    if (residual() < kClosed) {
      const Eigen::VectorXd rates = -J_.completeOrthogonalDecomposition().solve(constraints_.Phi_d);
      for (std::size_t k = 0; k < unknown_.size(); ++k) at.qd[unknown_[k]] = rates[static_cast<Eigen::Index>(k)];
      return true;
    }
    Eigen::VectorXd step = -J_.completeOrthogonalDecomposition().solve(constraints_.Phi);
    step *= std::min(1.0, kMaxStep / step.cwiseAbs().maxCoeff());
    for (std::size_t k = 0; k < unknown_.size(); ++k) at.q[unknown_[k]] += step[static_cast<Eigen::Index>(k)];
  }
  return false;
}

bool LoopClosure::solve(double t, Evaluation& at) {
  if (!solve_motion(t, at)) return false;
  solve_forces(at);
  return true;
}

bool LoopClosure::solve_motion(double t, Evaluation& at) {
  predict(t, at);
  set_drives(t, at);
  if (!close_position(at)) return false;
  correct_rates(at);
  step_.noalias() = J_lu_.solve(constraints_.bias);
  take_step(at.qdd);
  return at.qdd.allFinite();
}

/// Taylor's series of the unknown coordinates and their rates; their accelerations are asked for anew.
void LoopClosure::predict(double t, Evaluation& at) const {
  const double dt = t - at.t;
  for (const FrameIndex i : unknown_) {
    at.q[i] += dt * (at.qd[i] + 0.5 * dt * at.qdd[i]);
    at.qd[i] += dt * at.qdd[i];
    at.qdd[i] = 0.0;
  }
}

void LoopClosure::take_step(Eigen::VectorXd& coordinates) const {
  for (std::size_t k = 0; k < unknown_.size(); ++k) coordinates[unknown_[k]] -= step_[static_cast<Eigen::Index>(k)];
}

/// Newton from the predicted position. Only steps that contract from the first one on show that the solution is near.
bool LoopClosure::close_position(Evaluation& at) {
  constexpr int kMaxNear = 12;
  constexpr double kContraction = 0.25;
  double last = kMaxStep;
  for (int iteration = 0; iteration < kMaxNear; ++iteration) {
    calc_rows(at);
    J_lu_.compute(J_);
    if (residual() < kClosed) return true;
    step_.noalias() = J_lu_.solve(constraints_.Phi);
    const double size = step_.cwiseAbs().maxCoeff();
    if (!(size < kContraction * last)) return false;
    last = size;
    take_step(at.q);
    // The rates along, so that the rows of the next pass are already nearly theirs.
    step_.noalias() = J_lu_.solve(constraints_.Phi_d);
    take_step(at.qd);
  }
  return false;
}

/// Phi_d is linear in the rates: one step. The bias is not, so the rows are computed again, but for rates that were already right.
void LoopClosure::correct_rates(Evaluation& at) {
  constexpr double kRight = 1e-13;  // of the largest rate
  step_.noalias() = J_lu_.solve(constraints_.Phi_d);
  take_step(at.qd);
  if (!(step_.cwiseAbs().maxCoeff() <= kRight * at.qd.cwiseAbs().maxCoeff())) calc_rows(at);
}

/// With all accelerations known the recursion gives every generalised force; those of the unknown coordinates are the reactions' doing.
void LoopClosure::solve_forces(Evaluation& at) {
  calc_frame_motions(ideal_, at.q, at.qd, at.qdd, at.frames);
  const Eigen::VectorXd& forces = inverse_dynamics_.calc(at.frames);
  for (std::size_t k = 0; k < unknown_.size(); ++k) step_[static_cast<Eigen::Index>(k)] = forces[unknown_[k]];
  // By its factors: solving with the transposed decomposition would allocate.
  J_lu_.matrixLU().triangularView<Eigen::Upper>().transpose().solveInPlace(step_);
  J_lu_.matrixLU().triangularView<Eigen::UnitLower>().transpose().solveInPlace(step_);
  Eigen::VectorXd& lambda = lambda_;
  lambda.noalias() = J_lu_.permutationP().transpose() * step_;
  for (std::size_t k = 0; k < at.joints.size(); ++k) at.joints[k].reaction_W = lambda.segment<3>(constraints_.row_of_joint(k));
  for (std::size_t k = 0; k < ideal_.drives.size(); ++k) {
    const FrameIndex d = ideal_.drives[k].coordinate;
    at.drive_force[static_cast<Eigen::Index>(k)] = forces[d] - constraints_.Phi_q.col(d).dot(lambda);
  }
}

}  // namespace engine
