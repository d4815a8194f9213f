// SPDX-License-Identifier: Apache-2.0
// The motion of a mechanism that its drives determine.
#include "engine/dynamics/loop_closure.h"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

#include "engine/dynamics/loop_closure_parts.h"
#include "engine/kinematics/plain_frame.h"
#include "engine/math/quintic.h"

namespace engine {

using namespace loop_closure;

namespace {

/// The quintic of a coordinate through two instants.
Quintic make_quintic(FrameIndex i, const Evaluation& before, const Evaluation& after) {
  return Quintic(after.t - before.t, before.q[i], before.qd[i], before.qdd[i],
                 after.q[i], after.qd[i], after.qdd[i]);
}

/// @param s  part of the way from one instant to the other
void interpolate_forces(double s, const Evaluation& before, const Evaluation& after, Evaluation& at) {
  const auto mix = [s](const auto& from, const auto& to, auto& mixed) {
    mixed = (1.0 - s) * from + s * to;
  };
  mix(before.drive_force, after.drive_force, at.drive_force);
  for (std::size_t k = 0; k < at.joints.size(); ++k) {
    mix(before.joints[k].reaction_W, after.joints[k].reaction_W, at.joints[k].reaction_W);
    mix(before.joints[k].moment_W, after.joints[k].moment_W, at.joints[k].moment_W);
  }
}

}  // namespace

void LoopClosure::extrapolate(double t, const Evaluation& before, const Evaluation& nearby,
                              Evaluation& at) const {
  constexpr double kFar = 5.0;  // intervals: beyond, the rounding of the two instants counts
  const double interval = nearby.t - before.t;
  const double s = (t - before.t) / interval;
  if (interval > 0.0 && std::abs(s) < kFar) {
    for (const FrameIndex i : unknown_) at.q[i] = make_quintic(i, before, nearby).value(s);
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
  assert(active_rows_.size() == unknown_.size());
  start_from_taylor_series(t, at);
  set_drives(t, at);
  if (!close_position(at)) return false;
  solve_rates(at);
  calc_rates(at);
  take_active(constraints_.bias);
  apply_newton_step(at.qdd);
  return at.qdd.allFinite();
}

/// Taylor series of the unknown coordinates; their accelerations are set to zero, to be solved for.
void LoopClosure::start_from_taylor_series(double t, Evaluation& at) const {
  const double dt = t - at.t;
  for (const FrameIndex i : unknown_) {
    at.q[i] += dt * (at.qd[i] + 0.5 * dt * at.qdd[i]);
    at.qdd[i] = 0.0;
  }
}

/// step_ <- the entries of the active rows
void LoopClosure::take_active(const Eigen::Ref<const Eigen::VectorXd>& rows) {
  for (std::size_t r = 0; r < active_rows_.size(); ++r)
    step_[static_cast<Eigen::Index>(r)] = rows[active_rows_[r]];
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
  constexpr double kNearSingular = 1e-2;  // a small residual leaves a large error then: one more step
  double last = kMaxStep;
  for (int iteration = 0; iteration < kMaxNear; ++iteration) {
    calc_positions(at);
    if (!factor()) return false;
    if (residual() < kClosed && (iteration > 0 || J_.pivot_ratio() > kNearSingular)) return true;
    take_active(constraints_.Phi);
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
      J_(r, k) = constraints_.Phi_q(active_rows_[r], unknown_[k]);
  return J_.factor();
}

/// Solves Phi_q qd = 0 for the unknown rates; those of the drives are given.
void LoopClosure::solve_rates(Evaluation& at) {
  for (const FrameIndex i : unknown_) at.qd[i] = 0.0;
  for (std::size_t r = 0; r < active_rows_.size(); ++r)
    step_[static_cast<Eigen::Index>(r)] = constraints_.Phi_q.row(active_rows_[r]).dot(at.qd);
  apply_newton_step(at.qd);
}

/// On the unknown coordinates the reactions alone act: Phi_q^T lambda equals their generalised forces.
void LoopClosure::solve_multipliers(const Eigen::VectorXd& forces) {
  for (std::size_t k = 0; k < unknown_.size(); ++k)
    step_[static_cast<Eigen::Index>(k)] = forces[unknown_[k]];
  J_.solve_transposed_in_place(step_.data());
  for (std::size_t r = 0; r < active_rows_.size(); ++r)
    lambda_[active_rows_[r]] = step_[static_cast<Eigen::Index>(r)];
}

/// With all accelerations known the recursion gives every generalised force.
void LoopClosure::solve_forces(Evaluation& at) {
  calc_frame_rates(ideal_, at.qd, at.qdd, at.frames);
  const Eigen::VectorXd& forces = inverse_dynamics_.calc(at.frames);
  solve_multipliers(forces);
  for (std::size_t k = 0; k < at.joints.size(); ++k) {
    const auto [force, moment] = constraints_.calc_reaction(k, lambda_, at.frames);
    at.joints[k].reaction_W = to_eigen(force);
    at.joints[k].moment_W = to_eigen(moment);
  }
  for (std::size_t k = 0; k < ideal_.drives.size(); ++k) {
    const FrameIndex d = ideal_.drives[k].coordinate;
    at.drive_force[static_cast<Eigen::Index>(k)] = forces[d] - constraints_.Phi_q.col(d).dot(lambda_);
  }
}

/// @param s  part of the way from one instant to the other
void LoopClosure::interpolate_coordinates(double s, const Evaluation& before, const Evaluation& after,
                                          Evaluation& at) const {
  for (const FrameIndex i : unknown_) {
    const Quintic q = make_quintic(i, before, after);
    at.q[i] = q.value(s);
    at.qd[i] = q.rate(s);
    at.qdd[i] = q.acceleration(s);
  }
}

/// By the Taylor series.
void LoopClosure::extend_coordinates(double dt, const Evaluation& before, Evaluation& at) const {
  for (const FrameIndex i : unknown_) {
    at.q[i] = before.q[i] + dt * (before.qd[i] + 0.5 * dt * before.qdd[i]);
    at.qd[i] = before.qd[i] + dt * before.qdd[i];
    at.qdd[i] = before.qdd[i];
  }
}

void LoopClosure::interpolate(double t, const Evaluation& before, const Evaluation& after,
                              Evaluation& at) const {
  const double interval = after.t - before.t, since = t - before.t;
  const double s = interval > 0.0 ? since / interval : 0.0;
  if (interval > 0.0)
    interpolate_coordinates(s, before, after, at);
  else
    extend_coordinates(since, before, at);
  set_drives(t, at);
  calc_frame_motions(ideal_, at.q, at.qd, at.qdd, at.frames);
  interpolate_forces(s, before, after, at);
}

}  // namespace engine
