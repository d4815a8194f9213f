// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "engine/integrate/energy_control.h"
#include "engine/integrate/observer.h"
#include "engine/integrate/pace_check.h"
#include "engine/integrate/run_outcome.h"
#include "engine/integrate/sample_times.h"
#include "engine/integrate/spherical_charts.h"
#include "engine/integrate/step_control.h"
#include "engine/integrate/stepper.h"
#include "engine/integrate/unstable_mode_limiter.h"
#include "engine/model/drive_piece.h"

namespace engine {

/// One run by fixed or error-controlled steps. Error-controlled steps end where a ring meets or leaves the
/// bore and where a drive's acceleration jumps.
class Integration {
 public:
  Integration(const Mechanism& mechanism, const RunOptions& options, Observer& observer);
  Integration(const Integration&) = delete;
  Integration& operator=(const Integration&) = delete;

  /// @param assembled  position and rates of all coordinates at t = 0
  [[nodiscard]] RunOutcome run(const Evaluation& assembled);

 private:
  [[nodiscard]] bool start(const Evaluation& assembled);
  void set_start(const Evaluation& assembled);
  [[nodiscard]] EvaluationStatus evaluate_start();
  [[nodiscard]] bool can_continue();
  [[nodiscard]] bool try_fixed_step();
  [[nodiscard]] bool accept_or_widen(const Trial& trial);
  [[nodiscard]] bool try_controlled_step();
  [[nodiscard]] double choose_step(double remaining);
  void set_next_step(double dt, double error);
  [[nodiscard]] bool passes_by_a_table() const;
  [[nodiscard]] Trial try_step(double dt);
  [[nodiscard]] bool accept_or_shrink(const Trial& trial, double dt);
  [[nodiscard]] bool land_on_event(double dt);
  void accept();
  void observe_step();
  void accept_contacts();
  void take_samples();
  [[nodiscard]] EvaluationStatus evaluate_sample(double t);
  [[nodiscard]] EvaluationStatus evaluate_inside(double t);
  [[nodiscard]] bool begin_charts();
  [[nodiscard]] double calc_drive_speed() const;
  void follow_speed();
  void jump();
  void cross_jumps(double t_end);
  void prepare(double dt);
  [[nodiscard]] EvaluationStatus evaluate(StepPoint& point);
  [[nodiscard]] EvaluationStatus widen_bristles();
  void fail(EvaluationStatus status);
  [[nodiscard]] std::string describe_lock_or(std::string otherwise) const;
  void fail(RunStatus status, std::string detail);

  Mechanism mechanism_;  ///< with the placements of the present charts
  SphericalCharts charts_;
  GivenChartObserver given_chart_observer_;
  DrivePiece piece_;
  const RunOptions options_;  ///< with an integrator chosen
  Observer& observer_;
  MotionSystem system_;
  Tolerance tolerance_;
  EnergyControl energy_control_;
  bool follows_speed_;    ///< where clearances set no scale, the motion does
  std::unique_ptr<Stepper> stepper_;
  StepControl control_;
  SampleTimes samples_;
  /// Shortest fixed step; a shorter remainder is rounding, [s].
  double sliver_;
  PaceCheck pace_check_;
  StepPoint start_, end_;
  StepPoint sample_;                                ///< the state between steps that was evaluated last
  std::vector<Penetration> rings_start_, rings_end_;  ///< at both ends of a controlled step
  UnstableModeLimiter unstable_mode_limiter_;
  double dt_ = 0.0;                               ///< of the next controlled step
  double speed_ = 0.0;                            ///< largest so far, of drives in the whole run, [m/s]
  int hopeless_steps_ = 0;                        ///< in a row
  long fixed_steps_ = 0;
  static constexpr long kNoStep = std::numeric_limits<long>::max();
  long crossing_step_ = kNoStep;                  ///< the last fixed step across a jump, until it is done
  RunOutcome outcome_;
  bool failed_ = false;
};

}  // namespace engine
