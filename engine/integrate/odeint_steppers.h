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

#include "engine/integrate/rodas.h"
#include "engine/integrate/stepper.h"
#include "engine/integrate/tolerance.h"

namespace engine {

/// An Odeint stepper on Eigen vectors. Its stages are resized at each step, since the state grows when
/// contact elements need more bristles; equal sizes allocate nothing. Odeint's default would resize them
/// once.
template <template <class, class, class, class, class, class, class> class Method>
using EigenStepper =
    Method<Eigen::VectorXd, double, Eigen::VectorXd, double, boost::numeric::odeint::vector_space_algebra,
           boost::numeric::odeint::default_operations, boost::numeric::odeint::always_resizer>;

/// The paper's integrator: the classical Runge-Kutta method of order 4.
class Rk4 final : public Stepper {
 public:
  [[nodiscard]] Trial try_step(MotionSystem& system, const StepPoint& start, double dt,
                               StepPoint& end) override;

 private:
  EigenStepper<boost::numeric::odeint::runge_kutta4> stepper_;
};

/// Dormand and Prince's method of order 5 with an error estimate of order 4. The last stage is the next
/// step's first.
class Dopri5 final : public Stepper {
 public:
  explicit Dopri5(const Tolerance& tolerance) : tolerance_(tolerance) {}

  [[nodiscard]] Trial try_step(MotionSystem& system, const StepPoint& start, double dt,
                               StepPoint& end) override;

 private:
  const Tolerance& tolerance_;
  Eigen::VectorXd local_error_;
  EigenStepper<boost::numeric::odeint::runge_kutta_dopri5> stepper_;
};

/// RODAS5(4): implicit, so that stiff contacts and links do not bound its steps. Tries from one start share
/// its Jacobian.
class Rodas5 final : public Stepper {
 public:
  explicit Rodas5(const Tolerance& tolerance) : tolerance_(tolerance) {}

  void accept() override { linearised_ = false; }
  void invalidate() override { linearised_ = false; }
  void jacobian_refreshed() override { linearised_ = true; }
  [[nodiscard]] Trial try_step(MotionSystem& system, const StepPoint& start, double dt,
                               StepPoint& end) override;

 private:
  const Tolerance& tolerance_;
  bool linearised_ = false;  ///< the system holds the Jacobian of the step's start
  Eigen::VectorXd local_error_;
  Rodas5Stepper stepper_;
};

}  // namespace engine
