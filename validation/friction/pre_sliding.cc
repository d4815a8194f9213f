// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "charts/chart.h"
#include "validation/friction/parts.h"
#include "validation/friction/published_law.h"
#include "validation/support/largest.h"

namespace validation {

namespace {

constexpr double kBreak = 1.5;       // F_s, [N]
constexpr double kPreSlidingStiffness = 1e5;   // sigma_0, [N/m]
constexpr double kTop = 0.95 * kBreak;
constexpr double kPreSlidingRate = 0.01;       // of the force, [N/s]: all but static
constexpr double kHold = 20.0;           // [s]
constexpr double kSpacing = 0.5;     // of the record, [s]

struct Record {
  std::vector<double> x, friction;
};

/// Displacement while the force changes from one value to another, infinitely slowly: dx = dF / (sigma_0 (1
/// -+ F / F_s)).
double dahl_displacement(double from, double to) {
  const double direction = to > from ? 1.0 : -1.0;
  return -direction * kBreak / kPreSlidingStiffness *
         std::log((kBreak - direction * to) / (kBreak - direction * from));
}

class Experiment {
 public:
  /// Lets the force change steadily to `to`.
  Record ramp(double to) {
    const double from = force_;
    const double begin = t_;
    const double duration = std::abs(to - from) / kPreSlidingRate;
    return drive([=](double t) { return from + (to - from) * (t - begin) / duration; }, duration, to);
  }
  void hold() {
    const double force = force_;
    (void)drive([force](double) { return force; }, kHold, force);
  }
  [[nodiscard]] double x() const { return y_[0]; }
  [[nodiscard]] double work() const { return y_[4]; }

 private:
  template <typename Force>
  Record drive(const Force& force, double duration, double end_force) {
    const auto rates = [&](const OdeState& y, OdeState& d, double t) {
      const BristleForce f = calc_on_line(published_law(), y[1], y[2], y[3]);
      const double friction = kLine.dot(f.force_ratio);
      d = {y[1], force(t) - friction, f.bristle_rate[0], f.bristle_rate[1], friction * y[1]};
    };
    auto stepper = make_fehlberg(1e-15, 1e-10);
    Record record;
    const double begin = t_;
    const int samples = static_cast<int>(std::lround(duration / kSpacing));
    for (int k = 1; k <= samples; ++k) {
      advance(stepper, rates, y_, t_, begin + duration * k / samples, dt_);
      record.x.push_back(y_[0]);
      record.friction.push_back(kLine.dot(calc_on_line(published_law(), y_[1], y_[2], y_[3]).force_ratio));
    }
    force_ = end_force;
    return record;
  }

  OdeState y_ = OdeState(5);  ///< of 1 kg: displacement, velocity, bristle, work done against friction
  double t_ = 0.0;
  double dt_ = 1e-5;
  double force_ = 0.0;
};

/// Largest distance in force of a recorded branch from the static curve through its first point.
double find_distance(const Record& branch, double x_from, double force_from, double direction) {
  Largest worst;
  for (std::size_t k = 0; k < branch.x.size(); ++k) {
    const double decay = std::exp(-direction * (branch.x[k] - x_from) * kPreSlidingStiffness / kBreak);
    const double expected = direction * kBreak + (force_from - direction * kBreak) * decay;
    worst.take(branch.friction[k] - expected);
  }
  return worst.value();
}

Figure draw_loop(const Record& load, const Record& down, const Record& up) {
  charts::Chart chart{.title = "pre-sliding displacement",
                      .x_label = "displacement [µm]",
                      .y_label = "friction force [N]",
                      .y_min = -1.7,
                      .y_max = 2.5};
  const auto add = [&chart](const Record& branch, const char* label, const char* colour, double width) {
    charts::Series series{
        .label = label, .x = branch.x, .y = branch.friction, .colour = colour, .width = width};
    for (double& x : series.x) x *= 1e6;
    chart.series.push_back(std::move(series));
  };
  add(load, "first loading", charts::kGrey, 4.0);
  add(down, "down", charts::kOrange, 1.2);
  add(up, "up again", charts::kBlue, 1.2);
  return {"friction_pre_sliding.svg",
          "Below break-away the mass moves by some hundredths of a millimetre, along a closed loop of "
          "hysteresis.",
          charts::draw({chart}, 1)};
}

}  // namespace

Findings compute_pre_sliding() {
  Experiment experiment;
  const Record load = experiment.ramp(kTop);
  experiment.hold();
  const double x_top = experiment.x();
  const double work_before = experiment.work();
  const Record down = experiment.ramp(-kTop);
  experiment.hold();
  const double x_bottom = experiment.x();
  const Record up = experiment.ramp(kTop);
  experiment.hold();

  const double first_load = dahl_displacement(0.0, kTop);
  const double across = dahl_displacement(kTop, -kTop);
  const double ratio = kTop / kBreak;
  const double area =
      2.0 * kBreak * kBreak / kPreSlidingStiffness * (std::log((1.0 + ratio) / (1.0 - ratio)) - 2.0 * ratio);
  // of the force at the end of a ramp, [N/m]
  const double end_slope = kPreSlidingStiffness * (1.0 - ratio);
  // velocity over circular frequency: 2.8e-8 m
  const double overshoot = kPreSlidingRate / end_slope / std::sqrt(end_slope / 1.0);
  // sigma_1 F' / sigma_0 = 3.2e-5 N
  const double damping_force = std::sqrt(kPreSlidingStiffness) * kPreSlidingRate / kPreSlidingStiffness;

  const std::string what = "pre-sliding (force on 1 kg 0 to 1.425 N, to -1.425 N, to 1.425 N): ";
  const char* static_limit = "static limit of the law: F = F_s (1 - exp(-sigma_0 x / F_s)) and its branches";
  const char* swing = "where a ramp ends the mass swings on by velocity over circular frequency, 2.8e-8 m";
  const char* damping = "bristle damping at 0.01 N/s is 3.2e-5 N; twice that";
  Findings findings;
  const std::size_t early = 2;  // 0.015 N: a hundredth of F_s
  findings.checks.push_back(compare(what + "mean slope of the force over the first 1 % of F_s",
                                    "static limit: sigma_0, less 0.5 %", load.friction[early] / load.x[early],
                                    load.friction[early] / dahl_displacement(0.0, load.friction[early]),
                                    2.0 * damping_force / load.friction[early] * kPreSlidingStiffness, "N/m",
                                    damping));
  findings.checks.push_back(
      compare(what + "displacement at 1.425 N", static_limit, x_top, first_load, overshoot, "m", swing));
  findings.checks.push_back(compare(what + "displacement at -1.425 N", static_limit, x_bottom,
                                    first_load + across, overshoot, "m", swing));
  findings.checks.push_back(compare(what + "displacement at 1.425 N again", "the loop is closed",
                                    experiment.x(), x_top, 1e-11, "m",
                                    "like the first time but for the tolerance of the integration, 1e-10"));
  findings.checks.push_back(limit(what + "force over displacement on the way down", static_limit,
                                  find_distance(down, x_top, kTop, -1.0), 2.0 * damping_force, "N", damping));
  findings.checks.push_back(limit(what + "force over displacement on the way up", static_limit,
                                  find_distance(up, x_bottom, -kTop, 1.0), 2.0 * damping_force, "N",
                                  damping));
  findings.checks.push_back(compare(what + "energy lost in the loop",
                                    "static limit: 2 F_s^2 / sigma_0 (ln((1 + r) / (1 - r)) - 2 r), r = 0.95",
                                    experiment.work() - work_before, area, 2.0 * kTop * overshoot, "J",
                                    "the mass swings on by 2.8e-8 m under 1.425 N at both ends"));
  findings.figures.push_back(draw_loop(load, down, up));
  return findings;
}

}  // namespace validation
