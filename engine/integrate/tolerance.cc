// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/tolerance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "engine/dynamics/state_layout.h"

namespace engine {

namespace {

bool carries(const Mechanism& mechanism, FrameIndex carrier, FrameIndex frame) {
  while (frame > carrier) frame = mechanism.coordinates[static_cast<std::size_t>(frame)].parent;
  return frame == carrier;
}

/// Moment of inertia of a body about the axis of a joint.
double calc_moment_of_inertia(const Coordinate& body, const FrameMotion& f, const FrameMotion& joint) {
  const Eigen::Vector3d s_F = f.R.transpose() * joint.axis;
  const Eigen::Vector3d arm = f.R.transpose() * (f.p - joint.p);
  // Velocity of the body's origin at a joint rate of 1 rad/s.
  const Eigen::Vector3d origin_rate = s_F.cross(arm);
  return body.mass * (origin_rate.squaredNorm() + 2.0 * origin_rate.dot(s_F.cross(body.com))) +
         s_F.dot(body.inertia * s_F);
}

}  // namespace

double calc_gyration_radius(const Mechanism& mechanism, FrameIndex rotation,
                            const std::vector<FrameMotion>& frames) {
  const FrameMotion& joint = frames[static_cast<std::size_t>(rotation)];
  double mass = 0.0;
  double moment = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Coordinate& body = mechanism.coordinates[i];
    if (body.mass == 0.0 || !carries(mechanism, rotation, static_cast<FrameIndex>(i))) continue;
    mass += body.mass;
    moment += calc_moment_of_inertia(body, frames[i], joint);
  }
  return mass > 0.0 ? std::sqrt(moment / mass) : 1.0;
}

void Tolerance::set_radii(const Mechanism& mechanism, const std::vector<FrameIndex>& free,
                          const std::vector<FrameMotion>& frames) {
  radii_.setOnes(static_cast<Eigen::Index>(free.size()));
  is_joint_ = radii_;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const Coordinate& coordinate = mechanism.coordinates[static_cast<std::size_t>(free[k])];
    const auto i = static_cast<Eigen::Index>(k);
    if (coordinate.motion == Motion::kRotation) radii_[i] = calc_gyration_radius(mechanism, free[k], frames);
    if (coordinate.role != CoordinateRole::kJoint) is_joint_[i] = 0.0;
  }
}

double Tolerance::follow_speed(double speed) {
  const double factor = speed > kRest && speed < kSlow ? speed / kOrdinarySpeed : 1.0;
  if (factor > 0.0) absolute_ = factor * requested_absolute_;
  return factor;
}

double Tolerance::calc_speed(const Eigen::Ref<const Eigen::VectorXd>& rates) const {
  double largest = 0.0;
  for (Eigen::Index k = 0; k < rates.size(); ++k)
    largest = std::max(largest, std::abs(rates[k]) * (radii_.size() > 0 ? is_joint_[k] * radii_[k] : 1.0));
  return largest;
}

double Tolerance::measure(const Eigen::VectorXd& error, const Eigen::VectorXd& y0, const Eigen::VectorXd& y1,
                          const Eigen::VectorXd& error_weights) const {
  double sum = 0.0;
  const auto add = [&](Eigen::Index i, double radius) {
    const double part = error_weights[i] * radius * error[i] /
                        (absolute_ + relative_ * radius * std::max(std::abs(y0[i]), std::abs(y1[i])));
    sum += part * part;
  };
  const StateLayout layout{.free = static_cast<int>(radii_.size())};
  for (int k = 0; k < layout.free; ++k) {
    add(layout.q(k), radii_[k]);
    add(layout.v(k), radii_[k]);
  }
  for (Eigen::Index i = layout.bristle(); i < error_weights.size(); ++i) add(i, 1.0);
  return std::sqrt(sum);
}

void Tolerance::calc_weights(const Eigen::VectorXd& y, const Eigen::VectorXd& error_weights,
                             Eigen::VectorXd& weights) const {
  const Eigen::Index n = radii_.size();
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    const double radius = radii_[i % n];
    weights[i] = error_weights[i] * radius / (absolute_ + relative_ * radius * std::abs(y[i]));
  }
  for (Eigen::Index i = 2 * n; i < error_weights.size(); ++i)
    weights[i] = error_weights[i] / (absolute_ + relative_ * std::abs(y[i]));
}

}  // namespace engine
