#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "engine/analysis/quantities.h"
#include "engine/analysis/sliding_work.h"
#include "engine/analysis/step_quadratic.h"
#include "engine/dynamics/evaluation.h"
#include "engine/model/rpsup.h"

namespace engine {

/// The channels of one run, sampled, with the extremes of the slider's acceleration between the samples.
class RpsupChannels {
 public:
  RpsupChannels(const RpsupParameters& parameters, const Rpsup& rpsup);

  void take_step(const Evaluation& start, const Evaluation& end);
  void take_sample(const Evaluation& at);

  [[nodiscard]] const SlidingWork& sliding_work() const { return sliding_work_; }

  /// @param work_turned_over  of the whole run: the energy residual's measure, [J]
  [[nodiscard]] Trajectory finish(double work_turned_over);

 private:
  void take_extremes(double until);
  void add_sliding_work(double part);
  void add_poses(const Evaluation& at);
  [[nodiscard]] double calc_deflection(const Evaluation& at) const;

  const RpsupParameters& parameters_;
  const Rpsup& rpsup_;
  Trajectory trajectory_;
  std::vector<double> row_;
  std::vector<Eigen::Quaterniond> last_turns_;  ///< of each link: a quaternion's sign follows the one before

  // The step at hand, and the extremes since the last sample.
  StepQuadratic acceleration_{0.0, 0.0, 0.0, 1.0};
  double step_start_ = 0.0;
  double step_dt_ = 0.0;
  double taken_ = 1.0;  ///< up to this place of the step the extremes are in
  double least_ = 0.0, most_ = 0.0;
  bool sampled_ = false;
  double first_balance_ = 0.0;

  SlidingWork sliding_work_;
};

}  // namespace engine
