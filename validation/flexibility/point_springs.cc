// SPDX-License-Identifier: Apache-2.0
// Springs and dampers between points of two bodies of a described linkage.

#include <array>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "engine/simulate_linkage.h"
#include "validation/flexibility/oscillation.h"
#include "validation/flexibility/parts.h"
#include "validation/support/linkage_runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

struct Method {
  const char* name;
  Integrator integrator;
};
constexpr std::array<Method, 3> kMethods{
    {{"dopri5", Integrator::kDopri5}, {"radau5", Integrator::kRadau5}, {"rodas5", Integrator::kRodas5}}};

/// Of 2 kg on a slide along x, 0.4 m from the point of the ground that it is tied to: m x'' = -k (x - L_0) -
/// d x'.
constexpr double kSpringMass = 2.0, kStiffness = 8e4, kDamping = 4.0, kFree = 0.3, kStart = 0.4;
Linkage make_block() {
  Linkage linkage;
  linkage.bodies = {{.name = "block", .mass = kSpringMass}};
  linkage.joints = {{.name = "block",
                     .kind = JointKind::kPrismatic,
                     .from = kGroundName,
                     .to = "block",
                     .placement = {},
                     .axes = {Axis::kX, Axis::kY},
                     .freedoms = {{.name = "block", .start = kStart}}}};
  linkage.springs = {{.name = "tie",
                      .from = kGroundName,
                      .to = "block",
                      .stiffness = kStiffness,
                      .damping = kDamping,
                      .free_length = kFree}};
  return linkage;
}

/// A bar on a pivot, its tip tied to a point beside it.
constexpr double kTip = 0.4, kBarMass = 1.5, kCentre = 0.25, kInertia = 0.02 + kBarMass * kCentre * kCentre,
                 kTie = 60.0, kTieDamping = 0.8;
constexpr double kTieFree = 0.25, kAnchorX = 0.3, kAnchorY = 0.5, kSpringGravity = 9.81, kStartAngle = -0.2;
Linkage make_tied_pendulum() {
  Linkage linkage;
  linkage.gravity_W = {0.0, -kSpringGravity, 0.0};
  linkage.bodies = {{.name = "bar", .mass = kBarMass, .com = {kCentre, 0.0, 0.0},
                     .inertia = Eigen::Vector3d(0.0, kInertia, kInertia).asDiagonal().toDenseMatrix()}};
  linkage.joints = {{.name = "bar",
                     .from = kGroundName,
                     .to = "bar",
                     .placement = {},
                     .freedoms = {{.name = "bar", .start = kStartAngle}}}};
  linkage.springs = {{.name = "tie",
                      .from = kGroundName,
                      .to = "bar",
                      .at = {kAnchorX, kAnchorY, 0.0},
                      .to_at = {kTip, 0.0, 0.0},
                      .stiffness = kTie,
                      .damping = kTieDamping,
                      .free_length = kTieFree}};
  return linkage;
}

/// The equation of its one angle: I a'' = -m g c cos a - (k (L - L_0) + d L') dL/da.
double calc_bar_acceleration(double a, double rate) {
  const double x = kAnchorX - kTip * std::cos(a), y = kAnchorY - kTip * std::sin(a);
  const double length = std::hypot(x, y);
  const double by_angle = kTip * (x * std::sin(a) - y * std::cos(a)) / length;
  return (-kBarMass * kSpringGravity * kCentre * std::cos(a) -
          (kTie * (length - kTieFree) + kTieDamping * by_angle * rate) * by_angle) /
         kInertia;
}

/// Solution of that equation by Runge and Kutta's method, in steps that leave an error below 1e-12. @returns
/// the angle, [rad]
double find_bar_angle(double t) {
  constexpr int kSteps = 20'000;
  const double h = t / kSteps;
  double a = kStartAngle, rate = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double a1 = calc_bar_acceleration(a, rate), r2 = rate + 0.5 * h * a1;
    const double a2 = calc_bar_acceleration(a + 0.5 * h * rate, r2), r3 = rate + 0.5 * h * a2;
    const double a3 = calc_bar_acceleration(a + 0.5 * h * r2, r3), r4 = rate + h * a3;
    const double a4 = calc_bar_acceleration(a + h * r3, r4);
    a += h / 6.0 * (rate + 2.0 * r2 + 2.0 * r3 + r4);
    rate += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  return a;
}

/// Body of 2 kg in a plane, thrown along x, with drag at its origin: m v' = -c v + m g.
constexpr double kThrownMass = 2.0, kDrag = 3.0, kThrown = 5.0;
Linkage make_thrown_body() {
  Linkage linkage;
  linkage.gravity_W = {0.0, -kSpringGravity, 0.0};
  linkage.bodies = {{.name = "body", .mass = kThrownMass, .inertia = 1e-3 * Eigen::Matrix3d::Identity()}};
  linkage.joints = {{.name = "plane",
                     .kind = JointKind::kPlanar,
                     .from = kGroundName,
                     .to = "body",
                     .placement = {},
                     .freedoms = {{.name = "x", .start_rate = kThrown}, {.name = "y"}, {.name = "turn"}}}};
  linkage.springs = {{.name = "drag", .from = kGroundName, .to = "body", .drag = kDrag}};
  return linkage;
}

/// Decay and circular frequency of the block's swing.
constexpr double kBlockDecay = 0.5 * kDamping / kSpringMass;                                 // [1/s]
const double kBlockOmega = std::sqrt(kStiffness / kSpringMass - kBlockDecay * kBlockDecay);  // [rad/s]

double calc_block_position(double t) {
  const double b = kBlockDecay, w = kBlockOmega;
  return kFree + (kStart - kFree) * std::exp(-b * t) * (std::cos(w * t) + b / w * std::sin(w * t));
}

/// Largest error of the block's position in a run. [m]
double find_block_error(const RunResult& run) {
  const std::vector<double>&t = column(run, "t_s"), &x = column(run, "block_m");
  double largest = 0.0;
  for (std::size_t k = 0; k < t.size(); ++k)
    largest = std::max(largest, std::abs(x[k] - calc_block_position(t[k])));
  return largest;
}

void add_block_swing(Findings& findings, const RunResult& run, const std::string& by) {
  const Oscillation swing = measure(find_extrema(column(run, "t_s"), column(run, "block_m"), 0.0));
  const double frequency = 0.5 * kBlockOmega / std::numbers::pi,
               ratio = kBlockDecay / std::sqrt(kStiffness / kSpringMass);
  const std::string why = "turning points by a parabola through samples 0.05 ms apart";
  findings.checks.push_back(compare("frequency of the block on the spring" + by,
                                    "sqrt(k / m - (d / (2 m))^2) / (2 pi)", swing.frequency, frequency,
                                    1e-8 * frequency, "Hz", why));
  findings.checks.push_back(
      compare("damping ratio of the block on the spring from the logarithmic decrement" + by,
              "d / (2 sqrt(k m))", swing.damping_ratio, ratio, 1e-6 * ratio, "1", why));
}

void add_block_on_a_spring(Findings& findings, const Method& method) {
  const RunResult run = run_linkage(make_block(), method.integrator, 1.0, 2e4);
  const std::string by = std::string(", ") + method.name;
  findings.checks.push_back(
      limit("block of 2 kg on a spring of 8e4 N/m and a damper of 4 N s/m, over 1 s" + by,
            "x = L_0 + a exp(-b t) (cos(w t) + b / w sin(w t))", 1e6 * find_block_error(run), 1e-3, "um",
            "the steps' tolerance of 1e-10, over 32 periods"));
  add_block_swing(findings, run, by);
}

void add_thrown_body(Findings& findings, const Method& method) {
  constexpr double kEnd = 1.0;
  const double rate = kDrag / kThrownMass, left = std::exp(-rate * kEnd);
  const double terminal = kSpringGravity / rate;
  const RunResult run = run_linkage(make_thrown_body(), method.integrator, kEnd, 100.0);
  const std::string by = std::string(" of a thrown body with drag, after 1 s, ") + method.name;
  const std::string why = "the steps' tolerance of 1e-10";
  findings.checks.push_back(compare("horizontal velocity" + by, "v_0 exp(-c t / m)",
                                    column(run, "x_m_s").back(), kThrown * left, 1e-8, "m/s", why));
  findings.checks.push_back(compare("fall" + by, "(m g / c) (t - (m / c) (1 - exp(-c t / m)))",
                                    -column(run, "y_m").back(), terminal * (kEnd - (1.0 - left) / rate), 1e-8,
                                    "m", why));
}

}  // namespace

Findings compute_block_on_a_spring() {
  Findings findings;
  for (const Method& method : kMethods) add_block_on_a_spring(findings, method);
  return findings;
}

Findings compute_tied_pendulum() {
  constexpr double kEnd = 2.0;
  Findings findings;
  const double expected = find_bar_angle(kEnd);
  for (const Method& method : kMethods)
    findings.checks.push_back(compare(
        std::string("angle of a pendulum tied by a spring and damper beside it, after 2 s, ") + method.name,
        "the equation of its angle, by Runge and Kutta's method",
        column(run_linkage(make_tied_pendulum(), method.integrator, kEnd, 100.0), "bar_rad").back(), expected,
        1e-9, "rad", "the steps' tolerance of 1e-10"));
  return findings;
}

Findings compute_thrown_body() {
  Findings findings;
  for (const Method& method : kMethods) add_thrown_body(findings, method);
  return findings;
}

}  // namespace validation
