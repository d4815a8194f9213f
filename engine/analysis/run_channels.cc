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

}  // namespace

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
  for (const Channel& channel : channels_) {
    trajectory_.channels.push_back(channel.info);
    if (channel.kind == Channel::Kind::kLeastAcceleration)
      extremes_.push_back({.coordinate = channel.coordinate});
  }
  for (QuantityInfo& pose : pose_channels(links_)) trajectory_.channels.push_back(std::move(pose));
  trajectory_.columns.resize(trajectory_.channels.size());
}

void RunChannels::reserve(std::size_t samples) {
  for (std::vector<double>& column : trajectory_.columns) column.reserve(samples);
}

void RunChannels::take_step(const Evaluation& start, const Evaluation& end) {
  take_extremes(1.0);
  step_start_ = start.t;
  step_dt_ = end.t - start.t;
  for (Extremes& extremes : extremes_) {
    const FrameIndex i = extremes.coordinate;
    extremes.acceleration = StepQuadratic(start.qdd[i], end.qdd[i], end.qd[i] - start.qd[i], step_dt_);
  }
  taken_ = 0.0;
}

void RunChannels::Extremes::take(double from, double until) {
  for (const double s : {from, acceleration.find_extremum(from, until), until}) {
    least = std::min(least, acceleration.value(s));
    most = std::max(most, acceleration.value(s));
  }
}

void RunChannels::take_extremes(double until) {
  if (!(taken_ < until)) return;
  for (Extremes& extremes : extremes_) extremes.take(taken_, until);
  taken_ = until;
}

RunChannels::Extremes& RunChannels::extremes_of(FrameIndex coordinate) {
  return *std::find_if(extremes_.begin(), extremes_.end(),
                       [&](const Extremes& e) { return e.coordinate == coordinate; });
}

double RunChannels::read(const Channel& channel, const Evaluation& at) {
  switch (channel.kind) {
    case Channel::Kind::kReading: return channel.read(at);
    case Channel::Kind::kLeastAcceleration:
      return std::min(extremes_of(channel.coordinate).least, at.qdd[channel.coordinate]);
    case Channel::Kind::kLargestAcceleration:
      return std::max(extremes_of(channel.coordinate).most, at.qdd[channel.coordinate]);
    case Channel::Kind::kImbalance: return at.energy.calc_balance() - first_balance_;
  }
  return 0.0;
}

void RunChannels::take_sample(const Evaluation& at) {
  if (!sampled_) {
    sampled_ = true;
    first_balance_ = at.energy.calc_balance();
    for (Extremes& extremes : extremes_) extremes.least = extremes.most = at.qdd[extremes.coordinate];
  }
  take_extremes(std::min(1.0, step_dt_ > 0.0 ? (at.t - step_start_) / step_dt_ : 1.0));
  if (prepare_) prepare_(at);
  row_.clear();
  for (const Channel& channel : channels_) row_.push_back(read(channel, at));
  add_poses(at);
  for (std::size_t k = 0; k < row_.size(); ++k) trajectory_.columns[k].push_back(row_[k]);
  for (Extremes& extremes : extremes_) extremes.least = extremes.most = at.qdd[extremes.coordinate];
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
