// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include "engine/dynamics/state_layout.h"
#include "engine/integrate/stepper.h"
#include "engine/integrate/tolerance.h"

namespace engine {

/// The Radau IIA method of order 5, L-stable and stiffly accurate: the three stages of a step are solved for at once, by Newton's method.
/// Where little but slow motion is left, in lasting contact above all, its steps are several times those of a Rosenbrock method, whose
/// stages follow the Jacobian at their start; and the Jacobian is made anew only when Newton's method has become slow with it.
/// Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.8.
class Radau5 final : public Stepper {
 public:
  /// @param error_weight  by which the error estimate counts more than it says. It is of order 3, and damped where the motion is fast
  explicit Radau5(const Tolerance& tolerance, double error_weight = 1.0);

  [[nodiscard]] Trial try_step(MotionSystem& system, const StepEnd& start, double dt, StepEnd& end) override;
  void accept() override;
  void invalidate() override;
  void jacobian_refreshed() override;
  void reset_convergence_rate() override { contraction_ = kUnknownContraction; }
  [[nodiscard]] double error_exponent() const override { return 4.0; }
  [[nodiscard]] Shifts shifts() const override { return Shifts::kRealAndComplex; }

 private:
  using Stages = std::array<Eigen::VectorXd, 3>;

  enum class Newton { kConverged, kTooSlow, kFailed };

  void make_room(const MotionSystem& system, const Eigen::VectorXd& y);
  void guess_stages(const StepEnd& start, const StateLayout& layout, double dt);
  void extrapolate(double ratio);
  [[nodiscard]] Newton solve_stages(MotionSystem& system, const StepEnd& start, double dt, Trial& trial);
  [[nodiscard]] Newton iterate(MotionSystem& system, const StepEnd& start, double dt, Trial& trial);
  [[nodiscard]] double correct_stages(MotionSystem& system, double dt);
  void find_defects(double dt);
  void add_changes();
  [[nodiscard]] double estimate_error(MotionSystem& system, const StepEnd& start, double dt);

  const Tolerance& tolerance_;
  double error_weight_;
  double close_;               ///< what may be left of Newton's method, in units of the tolerance
  Eigen::VectorXd weights_;    ///< of what error control looks at, at the step's start
  Stages Z_;                   ///< the stages' differences from the start
  Stages f_;                   ///< derivatives there
  Eigen::VectorXd W_;          ///< Z in the variables in which J couples no stages: the real one ...
  Eigen::VectorXd W_real_, W_imag_;  ///< ... and one of the conjugate two
  Eigen::VectorXd change_, change_real_, change_imag_;
  Eigen::VectorXd stage_;

  Stages last_Z_;              ///< of the step that ends at the start of this one
  double last_dt_ = 0.0;       ///< 0: none
  double tried_dt_ = 0.0;      ///< of the last try, if it was a good one
  double factored_dt_ = 0.0;   ///< the system's matrices are for this step; 0: none
  bool linearised_ = false;    ///< the system has a Jacobian ...
  bool fresh_ = false;         ///< ... and it is of this start
  static constexpr double kUnknownContraction = 0.5;
  double contraction_ = kUnknownContraction;  ///< by which an iteration brings Newton's method closer
};

}  // namespace engine
