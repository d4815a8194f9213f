// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
// Odeint's resizing of Eigen vectors must be known before its steppers.
#include <boost/numeric/odeint/external/eigen/eigen_resize.hpp>
#include <boost/numeric/odeint/algebra/default_operations.hpp>
#include <boost/numeric/odeint/algebra/vector_space_algebra.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/util/resizer.hpp>

#include "engine/dynamics/motion_system.h"
#include "engine/integrate/rodas.h"
#include "engine/integrate/tolerance.h"

namespace engine {

/// One end of a step: state, its derivative and what was evaluated with it.
struct StepEnd {
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

/// An Odeint stepper on Eigen vectors. The state grows when contact elements need more bristles, so its stages are resized at each step
/// (equal sizes allocate nothing); Odeint's default would resize them once.
template <template <class, class, class, class, class, class, class> class Stepper>
using EigenStepper = Stepper<Eigen::VectorXd, double, Eigen::VectorXd, double, boost::numeric::odeint::vector_space_algebra,
                             boost::numeric::odeint::default_operations, boost::numeric::odeint::always_resizer>;

/// The paper's integrator: the classical Runge-Kutta method of order 4.
class Rk4 {
 public:
  [[nodiscard]] Trial try_step(MotionSystem& system, const StepEnd& start, double dt, StepEnd& end);

 private:
  EigenStepper<boost::numeric::odeint::runge_kutta4> stepper_;
};

/// Dormand and Prince's method of order 5 with an error estimate of order 4. The last stage is the next step's first.
class Dopri5 {
 public:
  explicit Dopri5(const Tolerance& tolerance) : tolerance_(tolerance) {}

  [[nodiscard]] Trial try_step(MotionSystem& system, const StepEnd& start, double dt, StepEnd& end);

 private:
  const Tolerance& tolerance_;
  Eigen::VectorXd local_error_;
  EigenStepper<boost::numeric::odeint::runge_kutta_dopri5> stepper_;
};

/// RODAS5(4): implicit, so that stiff contacts and links do not bound its steps. Tries from one start share its Jacobian.
class Rodas5 {
 public:
  explicit Rodas5(const Tolerance& tolerance) : tolerance_(tolerance) {}

  /// The next try is from another start, or by other equations of motion, than the last.
  void begin_step() { linearised_ = false; }
  /// The system has been linearised, by others, at the start of the next step.
  void take_jacobian() { linearised_ = true; }
  [[nodiscard]] Trial try_step(MotionSystem& system, const StepEnd& start, double dt, StepEnd& end);

 private:
  const Tolerance& tolerance_;
  bool linearised_ = false;  ///< the system holds the Jacobian of the step's start
  Eigen::VectorXd local_error_;
  Rodas5Stepper stepper_;
};

}  // namespace engine
