// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/spherical_charts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>

#include "engine/kinematics/frame_motion.h"
#include "engine/model/spherical_rotations.h"

namespace engine {

namespace {

bool is_held(const Mechanism& mechanism, FrameIndex i) {
  const Coordinate& c = mechanism.coordinates[static_cast<std::size_t>(i)];
  return c.stiffness != 0.0 || c.damping != 0.0 ||
         std::ranges::any_of(mechanism.drives, [i](const Drive& d) { return d.coordinate == i; }) ||
         std::ranges::any_of(mechanism.actuations, [i](const Actuation& a) { return a.coordinate == i; }) ||
         std::ranges::any_of(mechanism.couplings, [i](const Coupling& coupling) {
           return coupling.coordinate == i || coupling.follows == i;
         });
}

/// @returns whether anything acts on the angles of a spherical joint
bool is_held_joint(const Mechanism& mechanism, FrameIndex psi) {
  return is_held(mechanism, psi) || is_held(mechanism, psi + 1) || is_held(mechanism, psi + 2);
}

/// First rotations of all spherical joints.
std::vector<FrameIndex> list_spherical_joints(const Mechanism& mechanism) {
  std::vector<FrameIndex> found;
  const auto count = static_cast<FrameIndex>(mechanism.coordinates.size());
  for (FrameIndex i = 0; i < count; ++i)
    if (are_spherical_rotations(mechanism, i)) found.push_back(i);
  return found;
}

Eigen::Matrix3d calc_rotation(const Eigen::Vector3d& angles) {
  return (Eigen::AngleAxisd(angles[0], Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angles[1], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles[2], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// Angular velocity in the body's frame, of the rates of (psi, theta, phi). A prime is a derivative by time:
///
///     w = (phi' - psi' sin theta,
///          theta' cos phi + psi' cos theta sin phi,
///          -theta' sin phi + psi' cos theta cos phi)
Eigen::Vector3d calc_velocity(const Eigen::Vector3d& q, const Eigen::Vector3d& qd) {
  const double s = std::sin(q[2]), c = std::cos(q[2]), across = qd[0] * std::cos(q[1]);
  return {qd[2] - qd[0] * std::sin(q[1]), qd[1] * c + across * s, -qd[1] * s + across * c};
}

/// Rates of the angles for a given angular velocity: the inverse of calc_velocity().
Eigen::Vector3d calc_rates(const Eigen::Vector3d& q, const Eigen::Vector3d& w) {
  const double s = std::sin(q[2]), c = std::cos(q[2]);
  const double psi = (w.y() * s + w.z() * c) / std::cos(q[1]);
  return {psi, w.y() * c - w.z() * s, w.x() + psi * std::sin(q[1])};
}

/// Derivative of calc_velocity() by time, without second derivatives of the angles.
Eigen::Vector3d calc_bias(const Eigen::Vector3d& q, const Eigen::Vector3d& qd) {
  const double s = std::sin(q[2]), c = std::cos(q[2]);
  const double across = qd[0] * std::cos(q[1]), across_d = -qd[0] * qd[1] * std::sin(q[1]);
  return {-qd[1] * across, -qd[1] * qd[2] * s + across_d * s + across * qd[2] * c,
          -qd[1] * qd[2] * c + across_d * c - across * qd[2] * s};
}

/// Least |cos theta|: nearer to gimbal lock psi and phi have no digits of their own left, nor have the rates.
constexpr double kLeastCosine = 3e-6;

/// Angles less whole turns, as near to others as may be.
Eigen::Vector3d unwrap(const Eigen::Vector3d& angles, const Eigen::Vector3d& near) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angles + kTurn * ((near - angles) / kTurn).array().round().matrix();
}

/// Angles of a rotation in gimbal lock, where psi may be any: that of `near`. theta stays a little beside it.
Eigen::Vector3d find_locked_angles(const Eigen::Matrix3d& R, const Eigen::Vector3d& near) {
  const double sign = R(2, 0) < 0.0 ? 1.0 : -1.0;  // of theta
  const double phi = sign * near[0] + std::atan2(sign * R(0, 1), sign * R(0, 2));
  return unwrap({near[0], sign * (0.5 * std::numbers::pi - kLeastCosine), phi}, near);
}

/// Angles of a rotation, those nearest to others.
Eigen::Vector3d find_angles(const Eigen::Matrix3d& R, const Eigen::Vector3d& near) {
  if (std::hypot(R(2, 1), R(2, 2)) < kLeastCosine) return find_locked_angles(R, near);
  const Eigen::Vector3d first(std::atan2(R(1, 0), R(0, 0)),
                              std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))),
                              std::atan2(R(2, 1), R(2, 2)));
  const Eigen::Vector3d second(first[0] + std::numbers::pi, std::numbers::pi - first[1],
                               first[2] + std::numbers::pi);
  const Eigen::Vector3d a = unwrap(first, near), b = unwrap(second, near);
  return (a - near).squaredNorm() <= (b - near).squaredNorm() ? a : b;
}

}  // namespace

SphericalCharts::SphericalCharts(const Mechanism& mechanism) : given_(mechanism) {
  for (const FrameIndex psi : list_spherical_joints(mechanism))
    if (!is_held_joint(mechanism, psi)) joints_.push_back({.psi = psi});
}

bool SphericalCharts::update(Mechanism& mechanism, Eigen::VectorXd& q, Eigen::VectorXd& qd) {
  constexpr double kFar = 0.36;  // cos theta, some 20 degrees before the singularity
  bool any = false;
  for (Joint& joint : joints_) {
    const Eigen::Vector3d angles = q.segment<3>(joint.psi);
    if (std::abs(std::cos(angles[1])) > kFar) continue;
    any = any_moved_ = true;
    joint.C = joint.C * calc_rotation(angles);
    const auto psi = static_cast<std::size_t>(joint.psi);
    mechanism.coordinates[psi].placement.R = given_.coordinates[psi].placement.R * joint.C;
    qd.segment<3>(joint.psi) = calc_velocity(angles, qd.segment<3>(joint.psi)).reverse().eval();
    q.segment<3>(joint.psi).setZero();
  }
  return any;
}

SphericalCharts::Angles SphericalCharts::angles_of(const Eigen::VectorXd& q) const {
  Angles angles;
  for (const Joint& joint : joints_) angles.emplace_back(q.segment<3>(joint.psi));
  return angles;
}

void SphericalCharts::restore_given(const Angles& near, Evaluation& at) const {
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const auto [psi, C] = joints_[k];
    const Eigen::Vector3d q = at.q.segment<3>(psi), qd = at.qd.segment<3>(psi), qdd = at.qdd.segment<3>(psi);
    const Eigen::Vector3d w = calc_velocity(q, qd), wd = calc_velocity(q, qdd) + calc_bias(q, qd);
    const Eigen::Vector3d given = find_angles(C * calc_rotation(q), near[k]);
    const Eigen::Vector3d rates = calc_rates(given, w);
    at.q.segment<3>(psi) = given;
    at.qd.segment<3>(psi) = rates;
    at.qdd.segment<3>(psi) = calc_rates(given, wd - calc_bias(given, rates));
  }
  calc_frame_motions(given_, at.q, at.qd, at.qdd, at.frames);
}

const Evaluation& GivenChartObserver::restore(const Evaluation& at, Evaluation& restored) const {
  if (!charts_.any_moved()) return at;
  restored = at;
  charts_.restore_given(predict_angles(at.t), restored);
  return restored;
}

void GivenChartObserver::keep(const Evaluation& at) {
  last_t_ = at.t;
  last_ = charts_.angles_of(at.q);
  last_rates_ = charts_.angles_of(at.qd);
}

/// Angles that go on from the last ones at their rates: a fast spin turns by more than a half in a step. Near
/// gimbal lock, where theta comes to it within the time, rates do not last: there the last angles.
SphericalCharts::Angles GivenChartObserver::predict_angles(double t) const {
  constexpr double kLasting = 0.5;
  SphericalCharts::Angles angles = last_;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const Eigen::Vector3d turned = (t - last_t_) * last_rates_[k];
    if (std::abs(turned[1]) < kLasting * std::abs(std::cos(angles[k][1]))) angles[k] += turned;
  }
  return angles;
}

void GivenChartObserver::on_step(const Evaluation& start, const Evaluation& end) {
  const Evaluation& from = restore(start, start_);
  const Evaluation& to = restore(end, end_);
  keep(to);
  observer_.on_step(from, to);
}

std::optional<FrameIndex> find_gimbal_lock(const Mechanism& mechanism, const Eigen::VectorXd& q,
                                           double near) {
  for (const FrameIndex psi : list_spherical_joints(mechanism))
    if (is_held_joint(mechanism, psi) && std::abs(std::cos(q[psi + 1])) < near) return psi + 1;
  return std::nullopt;
}

std::string describe_gimbal_lock(const Mechanism& mechanism, FrameIndex middle) {
  return "at a right angle of " + mechanism.coordinates[static_cast<std::size_t>(middle)].name +
         " the two other axes of its joint coincide, where springs, dampers, drives, actuators, loads "
         "and friction on its angles have no limit: leave them out, or turn the frame of the joint";
}

}  // namespace engine
