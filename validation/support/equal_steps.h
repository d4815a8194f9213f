// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <utility>

#include "engine/integrate/odeint_steppers.h"
#include "validation/engine_names.h"

namespace validation {

/// Dormand and Prince's method in `count` equal steps, without error control, on a mechanism without clearance.
/// @returns all that is known at the end, energies included
[[nodiscard]] inline Evaluation take_equal_steps(const Mechanism& mechanism, const Evaluation& assembled, double duration, int count) {
  MotionSystem system(mechanism);
  const Tolerance not_asked_for(1e-6, 1e-6);
  Dopri5 method(not_asked_for);
  StepPoint start;
  start.y = system.make_state(assembled.q, assembled.qd);
  start.f = Eigen::VectorXd::Zero(start.y.size());
  start.at = system.make_evaluation();
  if (system.calc_derivative(0.0, start.y, start.f, start.at) != EvaluationStatus::kOk) throw std::runtime_error("no accelerations at t = 0");
  StepPoint end = start;
  for (int k = 0; k < count; ++k) {
    start.t = duration * k / count;
    if (method.try_step(system, start, duration / count, end).status != EvaluationStatus::kOk) throw std::runtime_error("a step failed");
    std::swap(start, end);
  }
  if (system.calc_derivative(duration, start.y, start.f, start.at) != EvaluationStatus::kOk) throw std::runtime_error("no accelerations at the end");
  system.calc_energies(start.at);
  return start.at;
}

}  // namespace validation
