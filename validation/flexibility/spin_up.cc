// SPDX-License-Identifier: Apache-2.0
// A long beam is spun up: bending under large rotation, stiffened by its own centrifugal force.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/dynamics/motion_system.h"
#include "engine/flexible/rfem.h"
#include "engine/integrate/integration.h"
#include "charts/chart.h"
#include "validation/flexibility/parts.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr const char* kSpinUpGiven =
    "value given by an independent computation of the same model, to the digits shown";

constexpr double kLength = 10.0;        // [m]
constexpr double kEI = 1.4e4;           // [N m^2]
constexpr double kMassPerLength = 1.2;  // [kg/m]

/// A beam clamped to a hub that is driven: elements and springs by the engine's division, turning in one
/// plane. No gravity, no damping.
Mechanism make_beam(int segments) {
  constexpr double kBeamDiameter = 0.1;  // any: E makes up for it
  const double I = std::numbers::pi * std::pow(kBeamDiameter, 4) / 64.0;
  const UniformBeam whole = engine::make_beam({.length = kLength,
                                               .mass = kMassPerLength * kLength,
                                               .I_x = 1e-6,
                                               .diameter = kBeamDiameter,
                                               .youngs_modulus = kEI / I,
                                               .shear_modulus = 1.0,
                                               .damping_ratio = 0.0});
  const DividedBeam divided = divide_beam(whole, segments + 1);
  Mechanism beam;
  double x = 0.0;
  for (std::size_t r = 0; r < divided.elements.size(); ++r) {
    const RigidElement& rfe = divided.elements[r];
    beam.coordinates.push_back({.name = "psi_" + std::to_string(r),
                                .parent = static_cast<FrameIndex>(r) - 1,
                                .placement = {.p = {x, 0.0, 0.0}},
                                .axis = Axis::kZ,
                                .stiffness = r == 0 ? 0.0 : divided.sde.stiffness[0],
                                .mass = rfe.mass,
                                .com = {0.5 * rfe.length, 0.0, 0.0},
                                .inertia = rfe.inertia.asDiagonal()});
    x = rfe.length;
  }
  beam.drives = {{0, RunUp{6.0, 15.0}}};
  return beam;
}

/// Sideways position of the tip in the hub's frame.
class TipObserver : public QuietObserver {
 public:
  explicit TipObserver(double reach) : reach_(reach) {}

  void on_sample(const Evaluation& at) override {
    const FrameMotion& end = at.frames.back();
    t.push_back(at.t);
    lag.push_back(at.frames.front().R.col(1).dot(end.p + reach_ * end.R.col(0)));
  }
  std::vector<double> t, lag;

 private:
  double reach_;  ///< of the last element
};

struct SpinUp {
  std::vector<double> t, lag;      ///< [s], [m]
  double largest = 0.0, at = 0.0;  ///< lag, and when
};

/// Lag by the parabola through the three samples about the least.
SpinUp find_largest_lag(const TipObserver& tip) {
  const auto least = static_cast<std::size_t>(std::min_element(tip.lag.begin(), tip.lag.end()) -
                                              tip.lag.begin());
  const double before = tip.lag[least - 1], middle = tip.lag[least], after = tip.lag[least + 1];
  const double s = 0.5 * (before - after) / (before - 2.0 * middle + after);
  return {.t = tip.t,
          .lag = tip.lag,
          .largest = middle - 0.25 * s * (before - after),
          .at = tip.t[least] + 0.01 * s};
}

SpinUp simulate_spin_up(int segments, double duration) {
  const Mechanism beam = make_beam(segments);
  const RunOptions options{.duration = duration, .output_rate = 100.0, .integrator = Integrator::kDopri5,
                           .relative_tolerance = 1e-8, .absolute_tolerance = 1e-10};
  TipObserver observer(0.5 * kLength / segments);
  const RunOutcome end = Integration(beam, options, observer).run(MotionSystem(beam).make_evaluation());
  if (end.status != RunStatus::kSucceeded)
    throw std::runtime_error("a run of the validation failed: " + end.detail);
  return find_largest_lag(observer);
}

}  // namespace

Findings compute_spin_up() {
  Findings findings;
  const SpinUp five = simulate_spin_up(5, 7.5);
  const SpinUp ten = simulate_spin_up(10, 17.0);
  const SpinUp twenty = simulate_spin_up(20, 17.0);
  // Errors of n^-2 and n^-4 taken out.
  const double from_coarse = (4.0 * ten.largest - five.largest) / 3.0;
  const double from_fine = (4.0 * twenty.largest - ten.largest) / 3.0;
  const double limit = (16.0 * from_fine - from_coarse) / 15.0;
  const double order = std::log2((five.largest - ten.largest) / (ten.largest - twenty.largest));
  const std::string beam = "largest lag of the tip of a beam spun up from rest to 6 rad/s in 15 s, ";
  findings.checks.push_back(compare(beam + "10 segments", kSpinUpGiven, ten.largest, -0.5692, 5.1e-5, "m",
                                    "half of its last digit"));
  findings.checks.push_back(compare(beam + "20 segments", kSpinUpGiven, twenty.largest, -0.5726, 5.1e-5, "m",
                                    "half of its last digit"));
  findings.checks.push_back(compare(beam + "in the limit, from 5, 10 and 20 segments", kSpinUpGiven, limit,
                                    -0.5738, 5.1e-5, "m", "half of its last digit"));
  findings.checks.push_back(
      compare("order of the error of the largest lag of a beam spun up in the number of segments, 5, 10, 20",
              "2", order, 2.0, 0.06, "1", "terms of n^-4"));
  findings.checks.push_back(compare(
      "time of the largest lag of the tip of a beam spun up from rest to 6 rad/s in 15 s, 20 segments",
      kSpinUpGiven, twenty.at, 6.76, 5.1e-3, "s", "half of its last digit"));
  findings.tables.push_back({.caption = "Largest lag of the tip in the hub's frame: beam of 10 m, E I = "
                                        "1.4e4 N m^2, 1.2 kg/m, hub driven to 6 rad/s in 15 s by the "
                                        "cycloidal law.",
                             .head = {"segments", "largest lag [m]", "time of the largest lag [s]"},
                             .rows = {{"5", number(five.largest, 5), number(five.at, 4)},
                                      {"10", number(ten.largest, 5), number(ten.at, 4)},
                                      {"20", number(twenty.largest, 5), number(twenty.at, 4)},
                                      {"limit", number(limit, 5), ""}}});
  charts::Chart chart{.title = "Beam spun up: lag of the tip",
              .x_label = "t [s]",
              .y_label = "tip in the hub's frame [m]",
              .y_min = -0.65,
              .y_max = 0.2,
              .series = {}};
  chart.series.push_back({.label = "10 segments", .x = ten.t, .y = ten.lag, .colour = charts::kOrange});
  chart.series.push_back({.label = "20 segments", .x = twenty.t, .y = twenty.lag, .colour = charts::kBlue});
  findings.figures.push_back(
      {.file = "spin_up.svg",
       .caption = "Lag of the tip of a beam that is spun up to 6 rad/s in 15 s, 10 and 20 segments.",
       .svg = charts::draw({chart}, 1)});
  return findings;
}

}  // namespace validation
