// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/loop_closure.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/QR>

#include "engine/kinematics/plain_frame.h"
#include "engine/math/quintic.h"

namespace engine {

namespace {

constexpr double kClosed = 1e-13;  // of Phi, [m] and [1]: rounding of positions near 1 m
constexpr int kMaxIterations = 100;
constexpr double kMaxStep = 0.5;  // of a Newton step, [rad] or [m]; a full one from afar may leave the branch

Mechanism make_ideal(Mechanism mechanism) {
  for (CutJoint& joint : mechanism.cut_joints) joint.clearance.reset();
  mechanism.drive_rows = DriveRows::kEliminated;
  return mechanism;
}

/// Coordinates that are not driven and for which `holds` is true.
template <typename Holds>
std::vector<FrameIndex> find_coordinates(const Mechanism& mechanism, const Holds& holds) {
  std::vector<FrameIndex> found;
  for (FrameIndex i = 0; i < static_cast<FrameIndex>(mechanism.coordinates.size()); ++i) {
    const bool driven = std::any_of(mechanism.drives.begin(), mechanism.drives.end(),
                                    [i](const Drive& d) { return d.coordinate == i; });
    if (!driven && holds(mechanism.coordinates[static_cast<std::size_t>(i)])) found.push_back(i);
  }
  return found;
}

bool is_unloaded_spring(const Coordinate& c) { return c.stiffness != 0.0 && !c.spring_yields; }
bool is_found_by_loops(const Coordinate& c) { return !is_unloaded_spring(c) && !c.start; }
bool is_rate_found_by_loops(const Coordinate& c) { return !is_unloaded_spring(c) && !c.start_rate; }
bool is_any(const Coordinate&) { return true; }

/// Complete orthogonal decomposition: J need not have full rank, and in a flat mechanism has not.
Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decompose(const Eigen::MatrixXd& J) {
  constexpr double kDependent = 1e-9;  // of the largest pivot
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kDependent);
  decomposition.compute(J);
  return decomposition;
}

/// Displacement of the driven coordinates when the first of them has moved by a small amount; zero if none
/// moves soon.
Eigen::VectorXd calc_drive_displacement(const Mechanism& mechanism) {
  constexpr double kSmallDisplacement = 1e-4;   // [rad] or [m]
  constexpr double kFirst = 1e-9, kSoon = 0.2;  // [s]; a drive that starts later finds the linkage elsewhere
  Eigen::VectorXd displacement =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mechanism.coordinates.size()));
  for (double t = kFirst; t < kSoon; t *= 1.1) {
    for (const Drive& drive : mechanism.drives)
      displacement[drive.coordinate] =
          calc_driven_motion(drive.law, t).q - calc_driven_motion(drive.law, 0.0).q;
    if (displacement.cwiseAbs().maxCoeff() >= kSmallDisplacement) return displacement;
  }
  return Eigen::VectorXd::Zero(displacement.size());
}

/// Numerical rank of J.
Eigen::Index rank_of(const Eigen::MatrixXd& J) { return J.size() == 0 ? 0 : decompose(J).rank(); }

}  // namespace

LoopClosure::LoopClosure(const Mechanism& mechanism)
    : ideal_(make_ideal(mechanism)),
      unknown_(find_coordinates(ideal_, is_found_by_loops)),
      constraints_(ideal_),
      inverse_dynamics_(ideal_),
      J_(unknown_.size()) {
  Eigen::Index row = 0;
  for (const CutJoint& joint : mechanism.cut_joints)
    for (const Eigen::Index end = row + rows_of(joint.kind).count(); row < end; ++row)
      if (!joint.clearance) rigid_rows_.push_back(row);
  for (; row < constraints_.count(); ++row) rigid_rows_.push_back(row);
  J_.resize(unknown_.size());
  step_.setZero(static_cast<Eigen::Index>(unknown_.size()));
}

bool LoopClosure::is_determined() const {
  const auto at_rest = [](const Coordinate& c) { return c.stiffness == 0.0 && c.damping == 0.0; };
  return ideal_.springs.empty() &&
         std::all_of(ideal_.coordinates.begin(), ideal_.coordinates.end(), at_rest) &&
         constraints_.count() == static_cast<Eigen::Index>(unknown_.size()) &&
         unknown_.size() + ideal_.drives.size() == ideal_.coordinates.size();
}

void LoopClosure::set_drives(double t, Evaluation& at) const {
  at.t = t;
  for (const Drive& drive : ideal_.drives) {
    const DrivenMotion motion = calc_driven_motion(drive.law, piece_.clamp(t));
    at.q[drive.coordinate] = motion.q;
    at.qd[drive.coordinate] = motion.qd;
    at.qdd[drive.coordinate] = motion.qdd;
  }
}

void LoopClosure::calc_positions(Evaluation& at) {
  calc_frame_poses(ideal_, at.q, at.frames);
  constraints_.calc_positions(at.q, at.frames);
}

void LoopClosure::calc_rates(Evaluation& at) {
  calc_frame_rates(ideal_, at.qd, at.qdd, at.frames);
  constraints_.calc_rates(at.q, at.qd, at.qdd, at.frames);
}

bool LoopClosure::assemble(double t, Evaluation& at) {
  at.q.setZero();
  at.qd.setZero();
  at.qdd.setZero();
  for (std::size_t i = 0; i < ideal_.coordinates.size(); ++i) {
    const Coordinate& c = ideal_.coordinates[i];
    at.q[static_cast<Eigen::Index>(i)] = c.start ? *c.start : is_unloaded_spring(c) ? 0.0 : c.assembly_guess;
    at.qd[static_cast<Eigen::Index>(i)] = c.start_rate.value_or(0.0);
  }
  set_drives(t, at);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    calc_positions(at);
    if (residual() < kClosed) return assemble_rates(at);
    if (unknown_.empty()) return false;
    Eigen::VectorXd step = -decompose(calc_columns(unknown_)).solve(constraints_.Phi);
    step *= std::min(1.0, kMaxStep / step.cwiseAbs().maxCoeff());
    for (std::size_t k = 0; k < unknown_.size(); ++k) at.q[unknown_[k]] += step[static_cast<Eigen::Index>(k)];
  }
  return false;
}

bool LoopClosure::assemble_rates(Evaluation& at) {
  calc_rates(at);
  if (constraints_.count() == 0) return true;
  const auto rigid = static_cast<Eigen::Index>(rigid_rows_.size());
  redundant_ = rigid - rank_of(calc_columns(find_coordinates(ideal_, is_any))(rigid_rows_, Eigen::all));
  std::vector<Eigen::Index> all_rows(static_cast<std::size_t>(constraints_.count()));
  std::iota(all_rows.begin(), all_rows.end(), Eigen::Index{0});
  // A journal that has clearance may also move in its bearing from the start.
  rates_fit_ = find_rates(all_rows, at) || find_rates(rigid_rows_, at);
  return rates_fit_;
}

/// Minimum-norm solution for the rates that are not given. False if the given rates violate the constraint
/// rows.
bool LoopClosure::find_rates(const std::vector<Eigen::Index>& rows, Evaluation& at) {
  constexpr double kFits = 1e-9;  // of the residual that the given rates alone leave, [m/s] and [1/s]
  const std::vector<FrameIndex> open = find_coordinates(ideal_, is_rate_found_by_loops);
  for (const FrameIndex i : open) at.qd[i] = 0.0;
  calc_rates(at);
  if (rows.empty()) return true;
  const double given = constraints_.Phi_d(rows).cwiseAbs().maxCoeff();
  if (!open.empty()) {
    const Eigen::VectorXd rates =
        -decompose(calc_columns(open)(rows, Eigen::all)).solve(constraints_.Phi_d(rows));
    for (std::size_t k = 0; k < open.size(); ++k) at.qd[open[k]] = rates[static_cast<Eigen::Index>(k)];
    calc_rates(at);
  }
  return constraints_.Phi_d(rows).cwiseAbs().maxCoeff() <= kFits * std::max(1.0, given);
}

bool LoopClosure::drives_can_start(const Evaluation& assembled) {
  const bool at_rest = assembled.qd.isZero(0.0);  // if not, assemble() has checked the velocities
  if (rigid_rows_.empty() || ideal_.drives.empty() || !at_rest) return true;
  const Eigen::VectorXd displacement = calc_drive_displacement(ideal_);
  return is_free(displacement) || closes_from_perturbed(assembled.q + displacement);
}

/// Whether the other coordinates can follow a small displacement of the drives, to first order.
bool LoopClosure::is_free(const Eigen::VectorXd& displacement) const {
  constexpr double kTorn = 0.5;  // of the residual of each drive alone: drives may differ a little
  constexpr double kFar = 1e3;   // of the drives' displacement: nearer to a dead position counts as one
  const Eigen::MatrixXd Phi_q = constraints_.Phi_q(rigid_rows_, Eigen::all);
  const Eigen::VectorXd change = minimum_norm_correction(Phi_q * displacement);
  const Eigen::VectorXd left = Phi_q * (displacement + change);
  return change.norm() <= kFar * displacement.norm() &&
         left.norm() <= kTorn * (Phi_q.cwiseAbs() * displacement.cwiseAbs()).norm();
}

/// Whether the loops close, with the drives fixed, from a perturbed position. In a dead position no
/// displacement is free to first order, but the linkage may still move.
bool LoopClosure::closes_from_perturbed(const Eigen::VectorXd& q) {
  constexpr double kPerturbation = 0.01;  // [rad] or [m]
  constexpr double kMeets = 1e-9;   // [m] and [1]
  Evaluation at;
  at.q = q;
  at.qd = at.qdd = Eigen::VectorXd::Zero(q.size());
  at.frames.resize(ideal_.coordinates.size());
  double perturbation = kPerturbation;
  for (const FrameIndex i : find_coordinates(ideal_, is_any))
    at.q[i] += std::exchange(perturbation, -perturbation);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    calc_positions(at);
    const Eigen::VectorXd gaps = constraints_.Phi(rigid_rows_);
    if (gaps.cwiseAbs().maxCoeff() < kMeets) return true;
    const Eigen::VectorXd step = minimum_norm_correction(gaps);
    const double size = step.cwiseAbs().maxCoeff();
    if (size == 0.0) return false;
    at.q += std::min(1.0, kMaxStep / size) * step;
  }
  return false;
}

/// Minimum-norm change of the coordinates that are not driven, to first order, that closes gaps in the rigid
/// rows.
Eigen::VectorXd LoopClosure::minimum_norm_correction(const Eigen::VectorXd& gaps) const {
  const std::vector<FrameIndex> others = find_coordinates(ideal_, is_any);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(ideal_.coordinates.size()));
  if (!others.empty()) change(others) = -decompose(calc_columns(others)(rigid_rows_, Eigen::all)).solve(gaps);
  return change;
}

Eigen::MatrixXd LoopClosure::calc_columns(const std::vector<FrameIndex>& coordinates) const {
  Eigen::MatrixXd columns(constraints_.count(), static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k)) = constraints_.Phi_q.col(coordinates[k]);
  return columns;
}

void LoopClosure::extrapolate(double t, const Evaluation& before, const Evaluation& nearby,
                              Evaluation& at) const {
  constexpr double kFar = 5.0;  // intervals: beyond, the rounding of the two instants counts
  const double interval = nearby.t - before.t;
  const double s = (t - before.t) / interval;
  if (interval > 0.0 && std::abs(s) < kFar) {
    for (const FrameIndex i : unknown_) {
      const Quintic q(interval, before.q[i], before.qd[i], before.qdd[i],
                      nearby.q[i], nearby.qd[i], nearby.qdd[i]);
      at.q[i] = q.value(s);
    }
    at.t = t;
  } else {
    at.q = nearby.q;
    at.t = nearby.t;
  }
  at.qd = nearby.qd;
  at.qdd = nearby.qdd;
}

bool LoopClosure::solve(double t, Evaluation& at) {
  if (!solve_motion(t, at)) return false;
  solve_forces(at);
  return true;
}

bool LoopClosure::solve_motion(double t, Evaluation& at) {
  assert(constraints_.count() == step_.size());
  predict(t, at);
  set_drives(t, at);
  if (!close_position(at)) return false;
  solve_rates(at);
  calc_rates(at);
  step_ = constraints_.bias;
  apply_newton_step(at.qdd);
  return at.qdd.allFinite();
}

/// Taylor series of the unknown coordinates; their accelerations are set to zero, to be solved for.
void LoopClosure::predict(double t, Evaluation& at) const {
  const double dt = t - at.t;
  for (const FrameIndex i : unknown_) {
    at.q[i] += dt * (at.qd[i] + 0.5 * dt * at.qdd[i]);
    at.qdd[i] = 0.0;
  }
}

/// Newton step: solves J step = residual, which step_ holds, and subtracts the step from the unknown
/// coordinates.
void LoopClosure::apply_newton_step(Eigen::VectorXd& coordinates) {
  J_.solve_in_place(step_.data());
  for (std::size_t k = 0; k < unknown_.size(); ++k)
    coordinates[unknown_[k]] -= step_[static_cast<Eigen::Index>(k)];
}

/// Newton's method from the predicted position. The solution is near only if the steps contract from the
/// first one on. After many revolutions of an angle, its rounding bounds how well the loops close.
bool LoopClosure::close_position(Evaluation& at) {
  constexpr int kMaxNear = 12;
  constexpr double kContraction = 0.25;
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();  // of the largest coordinate
  double last = kMaxStep;
  for (int iteration = 0; iteration < kMaxNear; ++iteration) {
    calc_positions(at);
    if (!factor()) return false;
    if (residual() < kClosed) return true;
    step_ = constraints_.Phi;
    apply_newton_step(at.q);
    const double size = step_.cwiseAbs().maxCoeff();
    if (size <= kRounding * at.q.cwiseAbs().maxCoeff()) {
      calc_positions(at);
      return factor();
    }
    if (!(size < kContraction * last)) return false;
    last = size;
  }
  return false;
}

/// Factors Phi_q of the unknown coordinates. False if it is singular.
bool LoopClosure::factor() {
  for (std::size_t r = 0; r < J_.size(); ++r)
    for (std::size_t k = 0; k < J_.size(); ++k)
      J_(r, k) = constraints_.Phi_q(static_cast<Eigen::Index>(r), unknown_[k]);
  return J_.factor();
}

/// Solves Phi_q qd = 0 for the unknown rates; those of the drives are given.
void LoopClosure::solve_rates(Evaluation& at) {
  for (const FrameIndex i : unknown_) at.qd[i] = 0.0;
  step_.noalias() = constraints_.Phi_q * at.qd;
  apply_newton_step(at.qd);
}

/// With all accelerations known the recursion gives every generalised force. On the unknown coordinates the
/// reactions alone act: Phi_q^T lambda equals their forces.
void LoopClosure::solve_forces(Evaluation& at) {
  calc_frame_rates(ideal_, at.qd, at.qdd, at.frames);
  const Eigen::VectorXd& forces = inverse_dynamics_.calc(at.frames);
  Eigen::VectorXd& lambda = step_;
  for (std::size_t k = 0; k < unknown_.size(); ++k)
    lambda[static_cast<Eigen::Index>(k)] = forces[unknown_[k]];
  J_.solve_transposed_in_place(lambda.data());
  for (std::size_t k = 0; k < at.joints.size(); ++k) {
    const auto [force, moment] = constraints_.calc_reaction(k, lambda, at.frames);
    at.joints[k].reaction_W = to_eigen(force);
    at.joints[k].moment_W = to_eigen(moment);
  }
  for (std::size_t k = 0; k < ideal_.drives.size(); ++k) {
    const FrameIndex d = ideal_.drives[k].coordinate;
    at.drive_force[static_cast<Eigen::Index>(k)] = forces[d] - constraints_.Phi_q.col(d).dot(lambda);
  }
}

}  // namespace engine
