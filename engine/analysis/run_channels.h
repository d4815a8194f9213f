// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "engine/analysis/quantities.h"
#include "engine/analysis/readings.h"
#include "engine/analysis/step_quadratic.h"
#include "engine/model/mechanism.h"

namespace engine {

/// One column of a trajectory and where it comes from: a reading, or the least or largest acceleration of a
/// coordinate since the last sample.
struct Channel {
  enum class Kind { kReading, kLeastAcceleration, kLargestAcceleration, kImbalance };

  QuantityInfo info;
  Reading read = {};
  Kind kind = Kind::kReading;
  FrameIndex coordinate = 0;  ///< of the accelerations
};

/// The channels of the links' poses: origin, unit quaternion.
[[nodiscard]] std::vector<QuantityInfo> pose_channels(const std::vector<NamedFrame>& links);

/// The channels of one run, sampled; the poses of the links come last.
class RunChannels {
 public:
  RunChannels(std::vector<Channel> channels, const std::vector<NamedFrame>& links, Preparation prepare = {});

  /// Makes room for so many samples.
  void reserve(std::size_t samples);

  void take_step(const Evaluation& start, const Evaluation& end);
  void take_sample(const Evaluation& at);

  /// @param imbalance_scale  what imbalances are measured in, [J]; those of a run that turned over nothing
  /// stay as they are
  [[nodiscard]] Trajectory finish(double imbalance_scale);

 private:
  /// The extremes of one acceleration since the last sample.
  struct Extremes {
    FrameIndex coordinate = 0;
    StepQuadratic acceleration{0.0, 0.0, 0.0, 1.0};
    double least = 0.0, most = 0.0;
    void take(double from, double until);
  };

  void take_extremes(double until);
  [[nodiscard]] Extremes& extremes_of(FrameIndex coordinate);
  [[nodiscard]] double read(const Channel& channel, const Evaluation& at);
  void add_poses(const Evaluation& at);

  std::vector<Channel> channels_;
  std::vector<NamedFrame> links_;
  Preparation prepare_;
  Trajectory trajectory_;
  std::vector<double> row_;
  /// of each link: a quaternion's sign follows the one before
  std::vector<Eigen::Quaterniond> last_rotations_;

  std::vector<Extremes> extremes_;
  double step_start_ = 0.0;
  double step_dt_ = 0.0;
  double taken_ = 1.0;  ///< fraction of the step up to which the extremes are in
  bool sampled_ = false;
  double first_balance_ = 0.0;
};

}  // namespace engine
