// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "engine/analysis/quantities.h"
#include "engine/analysis/readings.h"
#include "engine/analysis/sample_extremes.h"
#include "engine/analysis/stepped_peak.h"
#include "engine/model/mechanism.h"

namespace engine {

/// One column of a trajectory and where it comes from: a reading, or the least or largest value since the
/// last sample of a coordinate's acceleration or of a load. The largest value's channel follows that of the
/// least one.
struct Channel {
  enum class Kind { kReading, kLeastAcceleration, kLeastLoad, kLargest, kImbalance };

  QuantityInfo info;
  Reading read = {};  ///< not of imbalances
  Kind kind = Kind::kReading;
  std::size_t index = 0;  ///< of a least value: the coordinate, or the load among Measured::loads
};

/// Channels of the least and of the largest value since the last sample of the quantity whose channel is STEM
/// and UNIT in one word: STEM_min UNIT, STEM_max UNIT.
/// @param kind   kLeastAcceleration or kLeastLoad  @param index  as Channel::index
[[nodiscard]] std::array<Channel, 2> extreme_channels(const std::string& stem, const std::string& unit,
                                                      const Reading& read, Channel::Kind kind,
                                                      std::size_t index);

/// The channels of the links' poses: origin, unit quaternion.
[[nodiscard]] std::vector<QuantityInfo> pose_channels(const std::vector<NamedFrame>& links);

/// The channels of one run, sampled; the poses of the links come last.
class RunChannels {
 public:
  RunChannels(std::vector<Channel> channels, const std::vector<NamedFrame>& links, Preparation prepare = {});

  /// Makes room for so many samples.
  void reserve(std::size_t samples);

  /// @param loads  RunMetrics::loads() of the step
  void take_step(const Evaluation& start, const Evaluation& end, std::span<const SteppedPeak> loads);
  /// Loads of the last step whose curves are known by its middle.
  void take_curves(std::span<const SteppedPeak> loads);
  void take_sample(const Evaluation& at);

  /// @param imbalance_scale  what imbalances are measured in, [J]; those of a run that turned over nothing
  /// stay as they are
  [[nodiscard]] Trajectory finish(double imbalance_scale);

 private:
  /// Extremes since the last sample, of a channel of least values and the next one.
  struct Extremes {
    std::size_t channel;
    SampleExtremes values{};
  };

  void take_extremes(double until);
  void sample_extremes(const Evaluation& at);
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
