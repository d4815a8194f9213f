// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/run_channels.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace engine {

namespace {

std::string pose_key(const NamedFrame& link, std::string_view part) {
  std::string key = "pose_" + link.name + "_";
  std::replace(key.begin(), key.end(), ',', '_');
  return key.append(part);
}

/// Takes a step's curve of a coordinate's acceleration.
void take_acceleration_curve(const Evaluation& start, const Evaluation& end, FrameIndex i,
                             SampleExtremes& extremes) {
  extremes.take_step(start.qdd[i], end.qdd[i]);
  extremes.take_curve({start.qdd[i], end.qdd[i], end.qd[i] - start.qd[i], end.t - start.t});
}

}  // namespace

std::array<Channel, 2> extreme_channels(const std::string& stem, const std::string& unit,
                                        const Reading& read, Channel::Kind kind, std::size_t index) {
  const std::string rest = " value of " + stem + unit + " since the sample before";
  QuantityInfo least{.key = stem + "_min" + unit, .help = "Least" + rest};
  QuantityInfo largest{.key = stem + "_max" + unit, .help = "Largest" + rest};
  return {Channel{.info = std::move(least), .read = read, .kind = kind, .index = index},
          Channel{.info = std::move(largest), .kind = Channel::Kind::kLargest}};
}

std::vector<QuantityInfo> pose_channels(const std::vector<NamedFrame>& links) {
  std::vector<QuantityInfo> channels;
  for (const NamedFrame& link : links)
    for (const std::string_view part : {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"})
      channels.push_back({.key = pose_key(link, part),
                          .help = "Pose of link (" + link.name +
                                  ") in the global frame: origin x, y, z or unit quaternion w, x, y, z",
                          .single_precision = true});
  return channels;
}

RunChannels::RunChannels(std::vector<Channel> channels, const std::vector<NamedFrame>& links,
                         Preparation prepare)
    : channels_(std::move(channels)),
      links_(links),
      prepare_(std::move(prepare)),
      last_rotations_(links.size(), Eigen::Quaterniond::Identity()) {
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    trajectory_.channels.push_back(channels_[k].info);
    const Channel::Kind kind = channels_[k].kind;
    if (kind == Channel::Kind::kLeastAcceleration || kind == Channel::Kind::kLeastLoad)
      extremes_.push_back({.channel = k});
  }
  for (QuantityInfo& pose : pose_channels(links_)) trajectory_.channels.push_back(std::move(pose));
  trajectory_.columns.resize(trajectory_.channels.size());
}

void RunChannels::reserve(std::size_t samples) {
  for (std::vector<double>& column : trajectory_.columns) column.reserve(samples);
}

void RunChannels::take_step(const Evaluation& start, const Evaluation& end,
                            std::span<const SteppedPeak> loads) {
  take_extremes(1.0);
  step_start_ = start.t;
  step_dt_ = end.t - start.t;
  for (Extremes& extremes : extremes_) {
    const Channel& channel = channels_[extremes.channel];
    if (channel.kind == Channel::Kind::kLeastLoad)
      extremes.values.take_step(loads[channel.index].start(), loads[channel.index].end());
    else
      take_acceleration_curve(start, end, static_cast<FrameIndex>(channel.index), extremes.values);
  }
  taken_ = 0.0;
}

void RunChannels::take_curves(std::span<const SteppedPeak> loads) {
  for (Extremes& extremes : extremes_) {
    const Channel& channel = channels_[extremes.channel];
    if (channel.kind == Channel::Kind::kLeastLoad && loads[channel.index].curve())
      extremes.values.take_curve(*loads[channel.index].curve());
  }
}

void RunChannels::take_extremes(double until) {
  if (!(taken_ < until)) return;
  for (Extremes& extremes : extremes_) extremes.values.take_part(taken_, until);
  taken_ = until;
}

void RunChannels::sample_extremes(const Evaluation& at) {
  for (Extremes& extremes : extremes_) {
    const double value = channels_[extremes.channel].read(at);
    if (!sampled_) extremes.values.restart(value);
    extremes.values.take(value);
    row_[extremes.channel] = extremes.values.least();
    row_[extremes.channel + 1] = extremes.values.largest();
    extremes.values.restart(value);
  }
}

void RunChannels::take_sample(const Evaluation& at) {
  if (!sampled_) first_balance_ = at.energy.calc_balance();
  take_extremes(std::min(1.0, step_dt_ > 0.0 ? (at.t - step_start_) / step_dt_ : 1.0));
  if (prepare_) prepare_(at);
  row_.assign(channels_.size(), 0.0);
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    if (channels_[k].kind == Channel::Kind::kReading) row_[k] = channels_[k].read(at);
    if (channels_[k].kind == Channel::Kind::kImbalance) row_[k] = at.energy.calc_balance() - first_balance_;
  }
  sample_extremes(at);
  sampled_ = true;
  add_poses(at);
  for (std::size_t k = 0; k < row_.size(); ++k) trajectory_.columns[k].push_back(row_[k]);
}

void RunChannels::add_poses(const Evaluation& at) {
  for (std::size_t k = 0; k < links_.size(); ++k) {
    Eigen::Matrix3d R = links_[k].placement.R;
    Eigen::Vector3d p = links_[k].placement.p;
    if (links_[k].frame != kGround) {
      const FrameMotion& frame = at.frames[static_cast<std::size_t>(links_[k].frame)];
      p = frame.p + frame.R * p;
      R = is_unrotated(links_[k].placement) ? frame.R : Eigen::Matrix3d(frame.R * R);
    }
    Eigen::Quaterniond rotation(R);
    if (rotation.dot(last_rotations_[k]) < 0.0) rotation.coeffs() = -rotation.coeffs();
    last_rotations_[k] = rotation;
    for (const double value : {p.x(), p.y(), p.z(), rotation.w(), rotation.x(), rotation.y(), rotation.z()})
      row_.push_back(value);
  }
}

Trajectory RunChannels::finish(double imbalance_scale) {
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    if (channels_[k].kind != Channel::Kind::kImbalance || !(imbalance_scale > 0.0)) continue;
    for (double& value : trajectory_.columns[k]) value /= imbalance_scale;
  }
  return std::move(trajectory_);
}

}  // namespace engine
