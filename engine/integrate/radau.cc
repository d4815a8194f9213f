#include "engine/integrate/radau.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "engine/integrate/radau_coefficients.h"

namespace engine {

namespace {

using K = RadauCoefficients;

constexpr int kMaxIterations = 10;
constexpr double kGoodContraction = 0.05;  // with less, the Jacobian is good for another step
// In units of the tolerance:
constexpr double kClose = 3e-4;      // what may be left of the iteration: more is noise to the energy account
constexpr double kNoStep = 40.0;     // error of a step whose iteration does not converge: the next try takes about two fifths of it

/// to <- factors[0] of[0] + factors[1] of[1] + factors[2] of[2]
template <typename Vector>
void combine(const K::Row& factors, const std::array<Eigen::VectorXd, K::kStages>& of, Vector&& to) {
  to = factors[0] * of[0] + factors[1] * of[1] + factors[2] * of[2];
}

}  // namespace

Trial Radau5::try_step(MotionSystem& system, const StepEnd& start, double dt, StepEnd& end) {
  Trial trial;
  make_room(system, start.y);
  tolerance_.calc_weights(start.y, system.error_shares(), weights_);
  tried_dt_ = 0.0;
  Newton newton = solve_stages(system, start, dt, trial);
  if (newton == Newton::kTooSlow && !fresh_) {
    forget();
    newton = solve_stages(system, start, dt, trial);
  }
  if (newton == Newton::kTooSlow) {
    last_dt_ = 0.0;
    trial.error = kNoStep;
  }
  if (newton != Newton::kConverged) return trial;
  trial.error = error_weight_ * estimate_error(system, start, dt);
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
  linearised_ = linearised_ && contraction_ <= kGoodContraction;
}

void Radau5::forget() {
  last_dt_ = factored_dt_ = 0.0;
  linearised_ = fresh_ = false;
}

void Radau5::make_room(const MotionSystem& system, const Eigen::VectorXd& y) {
  const Eigen::Index size = y.size();
  weights_.resize(system.controlled_size());
  for (std::size_t i = 0; i < K::kStages; ++i) {
    Z_[i].resize(size);
    f_[i].resize(size);
  }
  for (Eigen::VectorXd* each : {&W_, &change_, &stage_}) each->resize(size);
  for (Eigen::VectorXcd* each : {&W_complex_, &complex_change_}) each->resize(size);
}

/// From the polynomial of the step before, gone on; from the accelerations at the start if there is none.
void Radau5::guess_stages(const StepEnd& start, Eigen::Index free, double dt) {
  if (last_dt_ > 0.0)
    extrapolate(dt / last_dt_);
  else
    for (std::size_t i = 0; i < K::kStages; ++i) {
      const double until = K::c[i] * dt;
      Z_[i] = until * start.f;
      Z_[i].head(free) += 0.5 * until * until * start.f.segment(free, free);
    }
  combine(K::T_inverse[0], Z_, W_);
  combine(K::T_inverse[1], Z_, W_complex_.real());
  combine(K::T_inverse[2], Z_, W_complex_.imag());
}

/// @param ratio  of the step to the one before
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
    combine({basis[1], basis[2], basis[3] - 1.0}, last_Z_, Z_[i]);
  }
}

Radau5::Newton Radau5::solve_stages(MotionSystem& system, const StepEnd& start, double dt, Trial& trial) {
  if (!linearised_) {
    trial.status = system.linearise(start.t, start.y);
    if (trial.status != EvaluationStatus::kOk) return Newton::kFailed;
    linearised_ = fresh_ = true;
    factored_dt_ = 0.0;
  }
  if (dt != factored_dt_) factored_dt_ = system.factor(K::shift / dt) && system.factor(K::complex_shift / dt) ? dt : 0.0;
  const Newton newton = factored_dt_ == dt ? iterate(system, start, dt, trial) : Newton::kTooSlow;
  if (newton != Newton::kConverged) contraction_ = kUnknownContraction;
  return newton;
}

/// Newton's method with the Jacobian at hand.
Radau5::Newton Radau5::iterate(MotionSystem& system, const StepEnd& start, double dt, Trial& trial) {
  guess_stages(start, system.free_count(), dt);
  double last_change = 0.0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    for (std::size_t i = 0; i < K::kStages; ++i) {
      stage_ = start.y + Z_[i];
      ++trial.evaluations;
      trial.status = system.calc_derivative(start.t + K::c[i] * dt, stage_, f_[i]);
      if (trial.status != EvaluationStatus::kOk) return Newton::kFailed;
    }
    const double change = correct_stages(system, dt);
    if (!std::isfinite(change)) return Newton::kTooSlow;
    if (iteration > 0) {
      contraction_ = std::max(change / last_change, 1e-3);
      if (contraction_ >= 1.0) return Newton::kTooSlow;
    }
    if (change * contraction_ <= (1.0 - contraction_) * kClose) {
      // One iteration tells nothing new: what was known becomes slowly doubtful.
      contraction_ = std::min(iteration > 0 ? contraction_ : std::pow(contraction_, 0.8), kUnknownContraction);
      return Newton::kConverged;
    }
    last_change = change;
  }
  return Newton::kTooSlow;
}

/// One iteration. @returns its change, in units of the tolerance
double Radau5::correct_stages(MotionSystem& system, double dt) {
  combine(K::T_inverse[0], f_, change_);
  combine(K::T_inverse[1], f_, complex_change_.real());
  combine(K::T_inverse[2], f_, complex_change_.imag());
  change_ -= K::shift / dt * W_;
  complex_change_ -= K::complex_shift / dt * W_complex_;
  system.solve_in_place(change_);
  system.solve_in_place(complex_change_);
  W_ += change_;
  W_complex_ += complex_change_;
  for (std::size_t i = 0; i < K::kStages; ++i)
    Z_[i] = K::T[i][0] * W_ + K::T[i][1] * W_complex_.real() + K::T[i][2] * W_complex_.imag();
  const Eigen::Index controlled = weights_.size();  // 0: the drives decide the motion, and work and losses are integrals over it
  const double squares = change_.head(controlled).cwiseProduct(weights_).squaredNorm() +
                         complex_change_.head(controlled).cwiseAbs2().dot(weights_.cwiseAbs2());
  return std::sqrt(squares / static_cast<double>(K::kStages));
}

double Radau5::estimate_error(MotionSystem& system, const StepEnd& start, double dt) {
  combine({K::error[0] / dt, K::error[1] / dt, K::error[2] / dt}, Z_, change_);
  change_ += start.f;
  system.solve_in_place(change_);
  stage_ = start.y + Z_[2];
  return tolerance_.measure(change_, start.y, stage_, system.error_shares());
}

}  // namespace engine
