// SPDX-License-Identifier: Apache-2.0
// The linkage at rest with its flexible coupler: it swings about its sag under gravity, bending about its own
// z axis.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "validation/flexibility/oscillation.h"
#include "validation/flexibility/parts.h"
#include "validation/flexibility/rods.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kOutputRate = 20'000.0;  // [Hz]

/// The second geometry with an ideal joint, its drives at rest. Gravity acts across the coupler there, and
/// the coupler is pinned at both ends for bending about its own z axis (the joint R is free there): gravity
/// bends it so although it lies at an angle to x.
RpsupParameters linkage_at_rest(double damping_ratio, double gravity = 9.81) {
  RpsupParameters parameters = across_rpsup();
  parameters.coupler = Coupler::kFlexible;
  parameters.c_r = 0.0;
  parameters.crank_velocity = 0.0;
  parameters.rod_stroke = 0.0;
  parameters.coupler_damping_ratio = damping_ratio;
  parameters.gravity = gravity;
  return parameters;
}

/// Statics of the divided coupler, pinned at both ends: an sde at x turns by M(x) dl / (E I) with M = m g x
/// (l - x) / (2 l), that of the rod.
struct Sag {
  double middle, deflection;  ///< in the middle; of the far end from the near end's tangent, [m]
};
Sag calc_sag(double mass, double gravity, int segments) {
  const double l = Rod::kLength;
  Sag sag{0.0, 0.0};
  for (int k = 0; k < segments; ++k) {
    const double x = l * (k + 0.5) / segments;
    const double turn = 0.5 * mass * gravity * x * (l - x) / l * l / segments / Rod::EI();
    sag.middle += turn * 0.5 * std::min(x, l - x);  // moment in x of a unit force in the middle
    sag.deflection += turn * (l - x);
  }
  return sag;
}

void add_sag(Findings& findings) {
  const RunResult run = run_rpsup(linkage_at_rest(0.1), {.duration = 0.4});  // e^-20 of the swing is left
  const Sag sag = calc_sag(0.306, 9.81, 3);
  const double unit = 0.306 * 9.81 * std::pow(Rod::kLength, 3) / Rod::EI();
  const std::string why = "second order in the slope, 3e-4 squared, and the steps' tolerance";
  findings.checks.push_back(compare("sag of the coupler's middle in the linkage at rest, 3 segments",
                                    "statics of three springs: 37/2592 m g l^3 / (E I)",
                                    -1e6 * column(run, "pose_1_3_2_y_m").back(), 1e6 * sag.middle, 1e-4, "um",
                                    why));
  findings.checks.push_back(
      compare("deflection of the coupler's end in the linkage at rest (channel), 3 segments",
              "(1 + 1 / (2 n^2)) m g l^3 / (24 E I)", 1e3 * column(run, "coupler_deflection_mm").back(),
              1e6 * sag.deflection, 1e-4, "um", why));
  findings.tables.push_back(
      {.caption = "Sag of the coupler in the second geometry at rest over m g l^3 / (E I).",
       .head = {"", "3 segments, found", "statics of three springs", "rod"},
       .rows = {{"in the middle", number(-column(run, "pose_1_3_2_y_m").back() / unit, 6),
                 number(sag.middle / unit, 6), "5/384 = " + number(5.0 / 384.0, 6)},
                {"of the end from the tangent",
                 number(1e-3 * column(run, "coupler_deflection_mm").back() / unit, 6),
                 number(sag.deflection / unit, 6), "1/24 = " + number(1.0 / 24.0, 6)}}});
}

}  // namespace

Findings compute_sag_and_decay() {
  Findings findings;
  add_sag(findings);
  const Rod rod{.mass = 0.306, .I_x = 3.829e-6};
  const double divided = bars_frequency(rod, 3, kBendingModes[0]);
  const double undivided = euler_bernoulli_frequency(rod, kBendingModes[0]);
  Table table{.caption =
                  "The coupler in the second geometry, from straight, swings about its sag in its "
                  "pinned-pinned mode; frequency and damping ratio from the "
                  "turning points of its deflection. Damping is set for the undivided rod's frequency, so "
                  "its ratio is zeta omega / omega_1. The swing of "
                  "0.16 mm at 9.81 m/s^2 is not quite linear: under a tenth of gravity the damping ratio's "
                  "difference is a hundredth.",
              .head = {"zeta asked for", "gravity [m/s^2]", "frequency found [Hz]", "frequency expected [Hz]",
                       "zeta found", "zeta expected"},
              .rows = {},
              .keys = 2};
  struct Case {
    double zeta, gravity, bound;
  };
  for (const auto& [zeta, gravity, bound] :
       {Case{0.01, 9.81, 1e-4}, Case{0.01, 0.981, 2e-6}, Case{0.03, 0.981, 2e-6}}) {
    const RunResult run = run_rpsup(linkage_at_rest(zeta, gravity), {.duration = 0.4,
                                                                     .output_rate = kOutputRate,
                                                                     .integrator = Integrator::kDopri5,
                                                                     .relative_tolerance = 1e-9,
                                                                     .absolute_tolerance = 1e-12});
    // The third mode, 8 times as fast and so 8 times as much damped, is gone when the first turns are taken.
    const Oscillation found =
        measure(find_extrema(column(run, "t_s"), column(run, "coupler_deflection_mm"), 0.1));
    const double expected_ratio = zeta * divided / undivided;
    const double expected_frequency = divided * std::sqrt(1.0 - expected_ratio * expected_ratio);
    const std::string at = ", zeta = " + number(zeta) + ", gravity " + number(gravity) + " m/s^2";
    const std::string why =
        gravity > 1.0
            ? "the swing of 0.16 mm is not quite linear: the difference goes with its square, 1/100 under a "
              "tenth of gravity"
            : "what its square leaves in a swing of 0.016 mm, and turning points from samples 0.05 ms apart";
    findings.checks.push_back(compare("frequency of the coupler swinging in the linkage" + at,
                                      "eigenvalue of three segments (bars), times sqrt(1 - zeta^2)",
                                      found.frequency, expected_frequency, 0.1 * bound * expected_frequency,
                                      "Hz", why));
    findings.checks.push_back(compare("damping ratio from the logarithmic decrement" + at,
                                      "zeta omega / omega_1, omega of three segments, omega_1 of the rod",
                                      found.damping_ratio, expected_ratio, bound * expected_ratio, "1", why));
    table.rows.push_back({number(zeta), number(gravity), number(found.frequency, 7),
                          number(expected_frequency, 7), number(found.damping_ratio, 5),
                          number(expected_ratio, 5)});
  }
  findings.tables.push_back(std::move(table));
  return findings;
}

}  // namespace validation
