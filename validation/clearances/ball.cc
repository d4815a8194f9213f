// SPDX-License-Identifier: Apache-2.0
// A ball in a socket: impacts from the middle, sliding, rolling.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "validation/clearances/loose_body.h"
#include "validation/clearances/parts.h"
#include "validation/contact/sliding_mass.h"
#include "validation/support/linkage_runs.h"

namespace validation {

namespace {

constexpr double kSocketSpeed = 0.3;                     // [m/s]
constexpr double kSwing = 0.02;                          // amplitude, [rad]
constexpr double kCircleAngle = std::numbers::pi / 3.0;  // from the lowest point, [rad]

Eigen::Vector3d vector_at(const RunResult& run, std::size_t sample, const char* ending) {
  Eigen::Vector3d v;
  for (const int axis : {0, 1, 2}) v[axis] = column(run, std::string(1, "xyz"[axis]) + ending)[sample];
  return v;
}

/// Speeds of a ball without gravity at the middle of the socket, after each impact.
std::vector<double> list_speeds_in_the_middle(const RunResult& run) {
  std::vector<double> speeds;
  const std::size_t samples = column(run, "x_m").size();
  for (std::size_t k = 1; k < samples; ++k) {
    const Eigen::Vector3d before = vector_at(run, k - 1, "_m"), after = vector_at(run, k, "_m");
    if (before.dot(after) < 0.0) speeds.push_back(vector_at(run, k, "_m_s").norm());
  }
  return speeds;
}

/// Mean of the periods between zeros of a column; no number if there are not two.
double find_period(const RunResult& run, const char* key) {
  const std::vector<double>& x = column(run, key);
  const std::vector<double>& t = column(run, "t_s");
  std::vector<double> zeros;
  for (std::size_t k = 1; k < x.size(); ++k)
    if (x[k - 1] * x[k] < 0.0) zeros.push_back(t[k - 1] - x[k - 1] * (t[k] - t[k - 1]) / (x[k] - x[k - 1]));
  if (zeros.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  return 2.0 * (zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1);
}

/// Depth of the ball in the socket under a force. [m]
double find_depth(double force) { return std::pow(force / make_socket().K, 2.0 / 3.0); }

Check compare_swing(const char* how, const ClearanceParameters& socket, double inertia_factor) {
  const double weight = kLooseMass * kStandardGravity * std::cos(kSwing),
               R = kSocketPlay + find_depth(weight);
  const Linkage swinging = make_loose_body(
      JointKind::kSpherical, socket, {{{R * std::sin(kSwing)}, {-R * std::cos(kSwing)}, {}, {}, {}, {}}},
      {0.0, -kStandardGravity, 0.0});
  const RunResult run = run_linkage(swinging, Integrator::kRadau5, 1.0, 5000.0);
  const double expected = 2.0 * std::numbers::pi * std::sqrt(inertia_factor * R / kStandardGravity) *
                          (1.0 + kSwing * kSwing / 16.0);
  return compare(std::string("period of a ball that ") + how + " in its socket",
                 "2 pi sqrt(k (c + delta) / g) (1 + a^2 / 16), k = 1 + I / (m r^2) if it rolls",
                 find_period(run, "x_m"), expected, 5e-5 * expected, "s",
                 "the bristle gives by 1e-4 of the way; zeros between samples of 0.2 ms");
}

/// Horizontal circle in which a ball rolls around.
struct RollingCircle {
  double R;     ///< way of the ball's centre from the socket's, [m]
  double rate;  ///< of the angle around the vertical, [rad/s]
};

RollingCircle find_rolling_circle() {
  const double s = std::sin(kCircleAngle), c = std::cos(kCircleAngle);
  double R = kSocketPlay, rate = 0.0;
  for (int pass = 0; pass < 20; ++pass) {  // the normal force bends the radius
    rate = std::sqrt(5.0 / 7.0 * kStandardGravity / (R * c));
    R = kSocketPlay + find_depth(kLooseMass * (kStandardGravity * c + R * s * s * rate * rate));
  }
  return {R, rate};
}

Linkage make_circling_ball(const RollingCircle& circle) {
  const auto& [R, rate] = circle;
  ClearanceParameters socket = make_socket();
  socket.friction = make_stiff_friction(0.8);
  const double s = std::sin(kCircleAngle), c = std::cos(kCircleAngle);
  const double v = R * s * rate;  // along -z at the start, where the ball is at +x
  const double turn = v / kBallRadius;
  // w = v x n / r_j with n = (s, -c, 0)
  return make_loose_body(
      JointKind::kSpherical, socket,
      {{{R * s, 0.0}, {-R * c, 0.0}, {0.0, -v}, {0.0, 0.0}, {0.0, -s * turn}, {0.0, -c * turn}}},
      {0.0, -kStandardGravity, 0.0});
}

void compare_circle(Findings& findings) {
  const RollingCircle circle = find_rolling_circle();
  const auto& [R, rate] = circle;
  const RunResult run = run_linkage(make_circling_ball(circle), Integrator::kRadau5, 0.5, 2000.0);
  double off = 0.0;
  for (const double y : column(run, "y_m")) off = std::max(off, std::abs(y + R * std::cos(kCircleAngle)));
  findings.checks.push_back(limit("height of a ball that rolls in a horizontal circle, against the start",
                                  "a ball that does not spin about the normal is a pendulum under 5/7 g", off,
                                  1e-6, "m", "the bristle is unbent at the start"));
  findings.checks.push_back(compare("its period", "2 pi sqrt(7 (c + delta) cos(a) / (5 g))",
                                    find_period(run, "z_m"), 2.0 * std::numbers::pi / rate,
                                    1e-5 * 2.0 * std::numbers::pi / rate, "s",
                                    "the bristle is unbent at the start"));
}

ClearanceParameters make_socket_with_losses() {
  ClearanceParameters socket = make_socket();
  socket.chi = 0.75 * (1.0 - 0.25);
  return socket;
}

void add_impacts_from_the_middle(Findings& findings) {
  const ClearanceParameters socket = make_socket_with_losses();
  const double e = rebound_ratio(socket.chi);
  const Eigen::Vector3d along = Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0 * kSocketSpeed;
  const Linkage bouncing = make_loose_body(
      JointKind::kSpherical, socket, {{{0.0, along.x()}, {0.0, along.y()}, {0.0, along.z()}, {}, {}, {}}},
      Eigen::Vector3d::Zero());
  const RunResult run = run_linkage(bouncing, Integrator::kDopri5, 0.4, 2000.0);
  const std::vector<double> speeds = list_speeds_in_the_middle(run);
  for (const std::size_t n : {1, 2, 3})
    findings.checks.push_back(
        compare("speed of a ball after " + std::to_string(n) + " impacts from the middle",
                "e^n v, c (1 + e) = ln((1 + c) / (1 - c e))", speeds.at(n - 1),
                std::pow(e, static_cast<double>(n)) * kSocketSpeed, 1e-8, "m/s", kStepTolerance));
}

void add_impacts_beside_the_middle(Findings& findings) {
  const Eigen::Vector3d aside(0.0, 5e-3, 0.0), v(0.5, 0.0, 0.3), L = aside.cross(v);
  const Linkage around = make_loose_body(
      JointKind::kSpherical, make_socket_with_losses(),
      {{{aside.x(), v.x()}, {aside.y(), v.y()}, {aside.z(), v.z()}, {}, {}, {}}}, Eigen::Vector3d::Zero());
  const RunResult path = run_linkage(around, Integrator::kDopri5, 0.4, 1000.0);
  double off = 0.0;
  for (std::size_t k = 0; k < column(path, "x_m").size(); ++k)
    off = std::max(off, (vector_at(path, k, "_m").cross(vector_at(path, k, "_m_s")) - L).norm());
  findings.checks.push_back(
      limit("angular momentum by mass of a ball without friction about the socket's middle",
            "constant: the force is central", off, 1e-12, "m^2/s", kStepTolerance));
  findings.checks.push_back(limit("energy residual of its run", "0",
                                  metric_of(around, path, "energy_residual"), 1e-8, "1", kStepTolerance));
}

}  // namespace

Findings compute_ball_impacts() {
  Findings findings;
  add_impacts_from_the_middle(findings);
  add_impacts_beside_the_middle(findings);
  return findings;
}

Findings compute_ball_pendulum() {
  Findings findings;
  ClearanceParameters rough = make_socket();
  rough.friction = make_stiff_friction(0.6);
  findings.checks.push_back(compare_swing("slides", make_socket(), 1.0));
  findings.checks.push_back(compare_swing("rolls", rough, 1.4));
  compare_circle(findings);
  return findings;
}

}  // namespace validation
