// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include "engine/dynamics/state_layout.h"
#include "engine/integrate/stepper.h"
#include "engine/integrate/tolerance.h"

namespace engine {

struct Radau5Settings {
  /// Factor on the error estimate, which is of order 3 and damped where the motion is fast.
  double error_weight = 1.0;
  double newton_tolerance = 1e-4;  ///< bound of the iterations' remaining error, in units of the tolerance
  double keep_jacobian_below = 0.02;  ///< convergence rate with which the Jacobian serves another step
};

/// The Radau IIA method of order 5, L-stable and stiffly accurate: simplified Newton iterations solve for the
/// three stages of a step together. Where only slow motion is left, above all in lasting contact, its steps
/// are several times those of a Rosenbrock method, whose stages are tied to the Jacobian at their start. The
/// Jacobian is computed again only when the iterations converge too slowly with it.
///
/// Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.8. Z, W, T, T_inverse
/// are theirs; the error estimate is Eq. (8.19).
class Radau5 final : public Stepper {
 public:
  explicit Radau5(const Tolerance& tolerance, const Radau5Settings& settings = {});

  [[nodiscard]] Trial try_step(MotionSystem& system, const StepPoint& start, double dt,
                               StepPoint& end) override;
  void accept() override;
  void invalidate() override;
  void jacobian_refreshed() override;
  void reset_convergence_rate() override { convergence_rate_ = kUnknownRate; }
  [[nodiscard]] double error_exponent() const override { return 4.0; }
  [[nodiscard]] Shifts shifts() const override { return Shifts::kRealAndComplex; }

 private:
  using Stages = std::array<Eigen::VectorXd, 3>;

  enum class NewtonOutcome { kConverged, kNotConverged, kFailed };

  void resize_work(const MotionSystem& system, const Eigen::VectorXd& y);
  void predict_stages(const StepPoint& start, const StateLayout& layout, double dt);
  void extrapolate(double ratio);
  [[nodiscard]] NewtonOutcome solve_stages(MotionSystem& system, const StepPoint& start, double dt,
                                           Trial& trial);
  [[nodiscard]] NewtonOutcome iterate(MotionSystem& system, const StepPoint& start, double dt,
                                      Trial& trial);
  [[nodiscard]] double newton_iteration(MotionSystem& system, double dt);
  void calc_residuals(double dt);
  void apply_update();
  [[nodiscard]] double estimate_error(MotionSystem& system, const StepPoint& start, double dt);

  static constexpr double kUnknownRate = 0.5;

  const Tolerance& tolerance_;
  Radau5Settings settings_;
  Eigen::VectorXd norm_weights_;  ///< of the entries under error control, at the step's start
  Stages Z_;                   ///< differences of the stages from the start
  Stages f_;                   ///< derivatives at the stages
  Eigen::VectorXd W_;          ///< T^-1 Z, the variables in which J couples no stages: the real one ...
  Eigen::VectorXd W_real_, W_imag_;  ///< ... and one of the conjugate two
  Eigen::VectorXd update_, update_real_, update_imag_;  ///< residuals, then updates of W
  Eigen::VectorXd stage_;

  Stages last_Z_;              ///< of the step that ends at the start of this one
  double last_dt_ = 0.0;       ///< [s]; 0: none
  double tried_dt_ = 0.0;      ///< of the last try, [s]; 0: it was rejected
  double factored_dt_ = 0.0;   ///< step that the system's factors belong to, [s]; 0: none
  bool linearised_ = false;    ///< the system has a Jacobian ...
  bool fresh_ = false;         ///< ... of this start
  double convergence_rate_ = kUnknownRate;  ///< factor by which an iteration reduces the error ...
  double measured_rate_ = 0.0;  ///< ... as last measured with this Jacobian, by two iterations; 0: not yet
};

}  // namespace engine
