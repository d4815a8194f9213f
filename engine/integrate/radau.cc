// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/radau.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/integrate/radau_coefficients.h"

namespace engine {

namespace {

using K = RadauCoefficients;

constexpr int kMaxNewtonIterations = 10;
constexpr double kRoundingErrors = 10.0;      // of a number, allowed whatever the tolerance
// In units of the tolerance, of a step whose iterations do not converge: the next try takes a third of it.
constexpr double kNewtonFailureError = 40.0;

/// to <- factors[0] of[0] + factors[1] of[1] + factors[2] of[2]
void combine_stages(const K::Row& factors, const std::array<Eigen::VectorXd, K::kStages>& of,
                    Eigen::VectorXd& to) {
  to = factors[0] * of[0] + factors[1] * of[1] + factors[2] * of[2];
}

}  // namespace

Radau5::Radau5(const Tolerance& tolerance, const Radau5Settings& settings)
    : tolerance_(tolerance), settings_(settings) {
  const double rounding = kRoundingErrors * std::numeric_limits<double>::epsilon() / tolerance.relative();
  settings_.newton_tolerance = std::max(settings_.newton_tolerance, rounding);
}

Trial Radau5::try_step(MotionSystem& system, const StepPoint& start, double dt, StepPoint& end) {
  Trial trial;
  resize_work(system, start.y);
  tolerance_.calc_weights(start.y, system.error_weights(), norm_weights_);
  tried_dt_ = 0.0;
  NewtonOutcome outcome = solve_stages(system, start, dt, trial);
  if (outcome == NewtonOutcome::kNotConverged && !fresh_) {
    invalidate();
    outcome = solve_stages(system, start, dt, trial);
  }
  if (outcome == NewtonOutcome::kNotConverged) {
    last_dt_ = 0.0;
    trial.error = kNewtonFailureError;
  }
  if (outcome != NewtonOutcome::kConverged) return trial;
  trial.error = settings_.error_weight * estimate_error(system, start, dt);
  if (!(trial.error <= 1.0)) return trial;
  tried_dt_ = dt;
  end.t = start.t + dt;
  end.y = start.y + Z_[2];
  end.f.resize(start.y.size());
  ++trial.evaluations;
  trial.status = system.calc_derivative(end.t, end.y, end.f, end.at);
  return trial;
}

void Radau5::accept() {
  std::swap(Z_, last_Z_);
  last_dt_ = tried_dt_;
  fresh_ = false;
  linearised_ = linearised_ && measured_rate_ <= settings_.keep_jacobian_below;
}

void Radau5::invalidate() {
  last_dt_ = factored_dt_ = 0.0;
  linearised_ = fresh_ = false;
}

void Radau5::jacobian_refreshed() {
  factored_dt_ = measured_rate_ = 0.0;
  linearised_ = fresh_ = true;
}

void Radau5::resize_work(const MotionSystem& system, const Eigen::VectorXd& y) {
  const Eigen::Index size = y.size();
  norm_weights_.resize(system.controlled_size());
  for (std::size_t i = 0; i < K::kStages; ++i) {
    Z_[i].resize(size);
    f_[i].resize(size);
  }
  for (Eigen::VectorXd* each : {&W_, &W_real_, &W_imag_, &update_, &update_real_, &update_imag_, &stage_})
    each->resize(size);
}

/// Predicts the stages by the collocation polynomial of the step before, or by the accelerations at the start
/// if there is no such step.
void Radau5::predict_stages(const StepPoint& start, const StateLayout& layout, double dt) {
  if (last_dt_ > 0.0)
    extrapolate(dt / last_dt_);
  else
    for (std::size_t i = 0; i < K::kStages; ++i) {
      const double until = K::c[i] * dt;
      Z_[i] = until * start.f;
      Z_[i].head(layout.free) += 0.5 * until * until * start.f.segment(layout.v(), layout.free);
    }
  combine_stages(K::T_inverse[0], Z_, W_);
  combine_stages(K::T_inverse[1], Z_, W_real_);
  combine_stages(K::T_inverse[2], Z_, W_imag_);
}

/// @param ratio  this step over the one before
void Radau5::extrapolate(double ratio) {
  constexpr std::array<double, 4> nodes{0.0, K::c[0], K::c[1], K::c[2]};
  for (std::size_t i = 0; i < K::kStages; ++i) {
    const double x = 1.0 + K::c[i] * ratio;
    std::array<double, 4> basis;
    for (std::size_t j = 0; j < 4; ++j) {
      basis[j] = 1.0;
      for (std::size_t k = 0; k < 4; ++k)
        if (k != j) basis[j] *= (x - nodes[k]) / (nodes[j] - nodes[k]);
    }
    combine_stages({basis[1], basis[2], basis[3] - 1.0}, last_Z_, Z_[i]);
  }
}

Radau5::NewtonOutcome Radau5::solve_stages(MotionSystem& system, const StepPoint& start, double dt,
                                           Trial& trial) {
  if (!linearised_) {
    trial.status = system.linearise(start.t, start.y, system.choose_newton_solver(Shifts::kRealAndComplex));
    if (trial.status != EvaluationStatus::kOk) return NewtonOutcome::kFailed;
    jacobian_refreshed();
  }
  if (dt != factored_dt_)
    factored_dt_ = system.factor(K::shift / dt) && system.factor(K::complex_shift / dt) ? dt : 0.0;
  const NewtonOutcome outcome =
      factored_dt_ == dt ? iterate(system, start, dt, trial) : NewtonOutcome::kNotConverged;
  if (outcome != NewtonOutcome::kConverged) convergence_rate_ = kUnknownRate;
  return outcome;
}

/// Simplified Newton iterations with the present Jacobian.
Radau5::NewtonOutcome Radau5::iterate(MotionSystem& system, const StepPoint& start, double dt,
                                      Trial& trial) {
  predict_stages(start, system.layout(), dt);
  double last_update = 0.0;
  for (int iteration = 0; iteration < kMaxNewtonIterations; ++iteration) {
    for (std::size_t i = 0; i < K::kStages; ++i) {
      stage_ = start.y + Z_[i];
      ++trial.evaluations;
      trial.status = system.calc_derivative(start.t + K::c[i] * dt, stage_, f_[i]);
      if (trial.status != EvaluationStatus::kOk) return NewtonOutcome::kFailed;
    }
    const double update = newton_iteration(system, dt);
    if (!std::isfinite(update)) return NewtonOutcome::kNotConverged;
    if (iteration > 0) {
      convergence_rate_ = measured_rate_ = std::max(update / last_update, 1e-3);
      if (convergence_rate_ >= 1.0) return NewtonOutcome::kNotConverged;
    }
    if (update * convergence_rate_ <= (1.0 - convergence_rate_) * settings_.newton_tolerance) {
      // One iteration measures no rate. The last one is trusted less each time: its power 0.8 is larger.
      convergence_rate_ =
          std::min(iteration > 0 ? convergence_rate_ : std::pow(convergence_rate_, 0.8), kUnknownRate);
      return NewtonOutcome::kConverged;
    }
    last_update = update;
  }
  return NewtonOutcome::kNotConverged;
}

/// @returns norm of the update of W, in units of the tolerance
double Radau5::newton_iteration(MotionSystem& system, double dt) {
  calc_residuals(dt);
  system.solve_in_place(update_);
  system.solve_in_place(update_real_, update_imag_);
  apply_update();
  const Eigen::Index controlled =
      norm_weights_.size();  // 0: the drives determine the motion; work and losses are integrals of it
  double squares = 0.0;
  for (const Eigen::VectorXd* each : {&update_, &update_real_, &update_imag_})
    squares += each->head(controlled).cwiseProduct(norm_weights_).squaredNorm();
  return std::sqrt(squares / static_cast<double>(K::kStages));
}

/// Residuals of the stage equations, T^-1 f - shift / dt W, in one pass.
void Radau5::calc_residuals(double dt) {
  const double shift = K::shift / dt, shift_real = K::complex_shift.real() / dt,
               shift_imag = K::complex_shift.imag() / dt;
  const auto& T = K::T_inverse;
  const double *f0 = f_[0].data(), *f1 = f_[1].data(), *f2 = f_[2].data();
  const double *W = W_.data(), *W_real = W_real_.data(), *W_imag = W_imag_.data();
  double *single = update_.data(), *real = update_real_.data(), *imag = update_imag_.data();
  const Eigen::Index size = update_.size();
#pragma GCC ivdep
  for (Eigen::Index k = 0; k < size; ++k) {
    single[k] = T[0][0] * f0[k] + T[0][1] * f1[k] + T[0][2] * f2[k] - shift * W[k];
    real[k] = T[1][0] * f0[k] + T[1][1] * f1[k] + T[1][2] * f2[k] -
              (shift_real * W_real[k] - shift_imag * W_imag[k]);
    imag[k] = T[2][0] * f0[k] + T[2][1] * f1[k] + T[2][2] * f2[k] -
              (shift_real * W_imag[k] + shift_imag * W_real[k]);
  }
}

/// W <- W + update, Z = T W, in one pass.
void Radau5::apply_update() {
  const auto& T = K::T;
  const double *single = update_.data(), *real = update_real_.data(), *imag = update_imag_.data();
  double *W = W_.data(), *W_real = W_real_.data(), *W_imag = W_imag_.data();
  double *Z0 = Z_[0].data(), *Z1 = Z_[1].data(), *Z2 = Z_[2].data();
  const Eigen::Index size = update_.size();
#pragma GCC ivdep
  for (Eigen::Index k = 0; k < size; ++k) {
    const double a = W[k] + single[k], b = W_real[k] + real[k], c = W_imag[k] + imag[k];
    W[k] = a;
    W_real[k] = b;
    W_imag[k] = c;
    Z0[k] = T[0][0] * a + T[0][1] * b + T[0][2] * c;
    Z1[k] = T[1][0] * a + T[1][1] * b + T[1][2] * c;
    Z2[k] = T[2][0] * a + T[2][1] * b + T[2][2] * c;
  }
}

double Radau5::estimate_error(MotionSystem& system, const StepPoint& start, double dt) {
  combine_stages({K::error[0] / dt, K::error[1] / dt, K::error[2] / dt}, Z_, update_);
  update_ += start.f;
  system.solve_in_place(update_);
  stage_ = start.y + Z_[2];
  return tolerance_.measure(update_, start.y, stage_, system.error_weights());
}

}  // namespace engine
