#include "engine/integrate/step_method.h"

#include <algorithm>
#include <cmath>

namespace engine {

namespace {

/// The equations of motion as Odeint calls them. After a failed evaluation the remaining stages are not evaluated.
class OdeintSystem {
 public:
  OdeintSystem(MotionSystem& system, Evaluation& at, EvaluationStatus& status) : system_(system), at_(at), status_(status) {}

  void operator()(const Eigen::VectorXd& y, Eigen::VectorXd& dydt, double t) const {
    if (status_ == EvaluationStatus::kOk) status_ = system_.calc_derivative(t, y, dydt, at_);
  }

 private:
  MotionSystem& system_;
  Evaluation& at_;
  EvaluationStatus& status_;
};

}  // namespace

Trial Rk4::try_step(MotionSystem& system, const StepEnd& start, double dt, StepEnd& end) {
  Trial trial;
  const OdeintSystem rhs(system, end.at, trial.status);
  end.t = start.t + dt;
  stepper_.do_step(rhs, start.y, start.f, start.t, end.y, dt);
  if (trial.status == EvaluationStatus::kOk) rhs(end.y, end.f, end.t);
  return trial;
}

Trial Dopri5::try_step(MotionSystem& system, const StepEnd& start, double dt, StepEnd& end) {
  Trial trial;
  const OdeintSystem rhs(system, end.at, trial.status);
  end.t = start.t + dt;
  local_error_.resize(start.y.size());
  stepper_.do_step(rhs, start.y, start.f, start.t, end.y, end.f, dt, local_error_);
  if (trial.status == EvaluationStatus::kOk) trial.error = calc_error(start.y, end.y, system.controlled_size());
  return trial;
}

/// Root mean square over the controlled entries, each in units of its tolerance.
double Dopri5::calc_error(const Eigen::VectorXd& y0, const Eigen::VectorXd& y1, Eigen::Index controlled) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < controlled; ++i) {
    const double scale = absolute_ + relative_ * std::max(std::abs(y0[i]), std::abs(y1[i]));
    const double ratio = local_error_[i] / scale;
    sum += ratio * ratio;
  }
  return std::sqrt(sum / static_cast<double>(controlled));
}

}  // namespace engine
