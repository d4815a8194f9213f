// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <Eigen/Core>

#include "engine/dynamics/motion_system.h"
#include "engine/integrate/tolerance.h"
#include "engine/model/run_options.h"

namespace engine {

/// Start, end or inside of a step: state, its derivative and what was evaluated with it.
struct StepPoint {
  double t = 0.0;  ///< [s]
  Eigen::VectorXd y;
  Eigen::VectorXd f;
  Evaluation at;
};

/// A step tried: whether the equations could be evaluated all the way, and the estimate of its local error.
/// Its end is evaluated only if the error is within the tolerance.
struct Trial {
  EvaluationStatus status = EvaluationStatus::kOk;
  double error = 0.0;   ///< in units of the tolerance; 0 for methods without an estimate
  int evaluations = 0;  ///< of the equations of motion
};

/// A method of integration. A stepper keeps from one try to the next what can serve again: the Jacobian, its
/// factors, the polynomial of the last step. Equal sizes of the state allocate nothing.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Tries a step from start. Tries from one start may follow each other; between two starts stands accept()
  /// or invalidate().
  [[nodiscard]] virtual Trial try_step(MotionSystem& system, const StepPoint& start, double dt,
                                       StepPoint& end) = 0;

  /// The last try is part of the run: the next try starts at its end.
  virtual void accept() {}
  /// The equations of motion have changed since the last try: nothing learned from earlier tries holds.
  virtual void invalidate() {}
  /// The equations of motion have changed a little: the Jacobian and the polynomial still serve, but how fast
  /// Newton's method converges with them is unknown again.
  virtual void reset_convergence_rate() {}
  /// Another user has linearised the system at the start of the next step.
  virtual void jacobian_refreshed() {}

  /// Power of the step with which the error estimate falls.
  [[nodiscard]] virtual double error_exponent() const { return 5.0; }
  /// Shifts of the matrices shift 1 - J that an implicit method factors.
  [[nodiscard]] virtual Shifts shifts() const { return Shifts::kReal; }
};

/// @param integrator  not kAuto
/// @param tolerance   outlives the stepper
[[nodiscard]] std::unique_ptr<Stepper> make_stepper(const Mechanism& mechanism, Integrator integrator,
                                                    const Tolerance& tolerance);

}  // namespace engine
