// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/odeint_steppers.h"

#include <functional>

namespace engine {

namespace {

/// The equations of motion as Odeint calls them, for the stages of one step. After a failed evaluation the
/// others are left out.
class StageSystem {
 public:
  StageSystem(MotionSystem& system, Trial& trial) : system_(system), trial_(trial) {}

  void operator()(const Eigen::VectorXd& y, Eigen::VectorXd& dydt, double t) {
    if (trial_.status != EvaluationStatus::kOk) return;
    ++trial_.evaluations;
    trial_.status = system_.calc_derivative(t, y, dydt);
  }

 protected:
  MotionSystem& system_;
  Trial& trial_;
};

/// Dopri5's stages; the last of them is at the step's end, and all that is evaluated there is kept.
class Dopri5System : public StageSystem {
 public:
  Dopri5System(MotionSystem& system, Trial& trial, Evaluation& at_end)
      : StageSystem(system, trial), at_end_(at_end) {}

  void operator()(const Eigen::VectorXd& y, Eigen::VectorXd& dydt, double t) {
    constexpr int kStages = 6;  // and the first, which the step before has evaluated
    if (trial_.status != EvaluationStatus::kOk || trial_.evaluations + 1 < kStages)
      return StageSystem::operator()(y, dydt, t);
    ++trial_.evaluations;
    trial_.status = system_.calc_derivative(t, y, dydt, at_end_);
  }

 private:
  Evaluation& at_end_;
};

/// The stages of rodas5 with their linear algebra.
class RodasSystem : public StageSystem {
 public:
  RodasSystem(MotionSystem& system, Trial& trial, bool& linearised)
      : StageSystem(system, trial), linearised_(linearised) {}

  void linearise(const Eigen::VectorXd& y, double t) {
    if (!linearised_) trial_.status = system_.linearise(t, y, system_.choose_newton_solver(Shifts::kReal));
    linearised_ = trial_.status == EvaluationStatus::kOk;
  }
  [[nodiscard]] const Eigen::VectorXd& time_derivative() const { return system_.time_derivative(); }
  [[nodiscard]] bool factor(double shift) { return linearised_ && system_.factor(shift); }
  void solve_in_place(Eigen::VectorXd& x) const { system_.solve_in_place(x); }

 private:
  bool& linearised_;
};

/// Evaluates the end of a step, which no stage has evaluated.
void evaluate_end(MotionSystem& system, StepPoint& end, Trial& trial) {
  ++trial.evaluations;
  trial.status = system.calc_derivative(end.t, end.y, end.f, end.at);
}

}  // namespace

Trial Rk4::try_step(MotionSystem& system, const StepPoint& start, double dt, StepPoint& end) {
  Trial trial;
  StageSystem rhs(system, trial);
  end.t = start.t + dt;
  stepper_.do_step(std::ref(rhs), start.y, start.f, start.t, end.y, dt);
  if (trial.status == EvaluationStatus::kOk) evaluate_end(system, end, trial);
  return trial;
}

Trial Dopri5::try_step(MotionSystem& system, const StepPoint& start, double dt, StepPoint& end) {
  Trial trial;
  Dopri5System rhs(system, trial, end.at);
  end.t = start.t + dt;
  local_error_.resize(start.y.size());
  stepper_.do_step(std::ref(rhs), start.y, start.f, start.t, end.y, end.f, dt, local_error_);
  if (trial.status == EvaluationStatus::kOk)
    trial.error = tolerance_.measure(local_error_, start.y, end.y, system.error_weights());
  return trial;
}

Trial Rodas5::try_step(MotionSystem& system, const StepPoint& start, double dt, StepPoint& end) {
  Trial trial;
  RodasSystem rhs(system, trial, linearised_);
  end.t = start.t + dt;
  end.f.resize(start.y.size());
  stepper_.do_step(std::ref(rhs), start.y, start.f, start.t, end.y, dt, local_error_);
  if (trial.status != EvaluationStatus::kOk) return trial;
  trial.error = tolerance_.measure(local_error_, start.y, end.y, system.error_weights());
  if (trial.error <= 1.0) evaluate_end(system, end, trial);
  return trial;
}

}  // namespace engine
