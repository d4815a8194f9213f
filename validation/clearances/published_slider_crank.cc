// SPDX-License-Identifier: Apache-2.0
// The planar slider-crank whose slider has play in its guide, against the results that Siconos publishes.

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "validation/clearances/parts.h"
#include "validation/contact/sliding_mass.h"
#include "validation/support/linkage_runs.h"

namespace validation {

namespace {

constexpr double kCrankOfTwo = 0.153, kRodOfTwo = 0.306;               // lengths, [m]
constexpr double kSliderHalfLength = 0.05, kSliderHalfHeight = 0.025;  // of the slider, [m]
constexpr double kGuidePlay = 1e-3;                                    // on each side, [m]
constexpr const char* kSiconosSource =
    "Siconos, examples/mechanics/SliderCrank, steps of 1e-5 s; model of Flores, Leine, Glocker (2010)";

/// The damping factor with which an impact returns e of its speed.
double find_damping_factor(double e) {
  double low = 0.0, high = 1.0 / e;
  for (int pass = 0; pass < 100; ++pass) {
    const double middle = 0.5 * (low + high);
    (rebound_ratio(middle) > e ? low : high) = middle;
  }
  return low;
}

ClearanceParameters make_guide(double e, double mu) {
  ClearanceParameters guide;
  guide.geometry = ContactGeometry::kBlockInSlot;
  guide.c_r = guide.c_y = kGuidePlay;
  guide.c_a = std::numeric_limits<double>::infinity();
  guide.block_x = kSliderHalfHeight;
  guide.block_y = 0.02;  // out of the plane, where nothing touches
  guide.L_b = 2.0 * kSliderHalfLength;
  guide.K = 1e11;
  guide.chi = find_damping_factor(e);
  if (mu > 0.0) guide.friction = FrictionParameters{.mu_s = mu, .mu_k = mu, .sigma_0 = 1e6, .sigma_1 = 100.0};
  return guide;
}

LinkageBody make_uniform(const char* name, double mass, double length, double moment) {
  const double about_origin = moment + mass * length * length / 4.0;
  return {.name = name,
          .mass = mass,
          .com = {0.5 * length, 0.0, 0.0},
          .inertia = Eigen::Vector3d(0.1 * moment, about_origin, about_origin).asDiagonal()};
}

LinkageJoint make_guide_joint(const ClearanceParameters& guide) {
  return {.name = "guide",
          .kind = JointKind::kPrismatic,
          .from = kGroundName,
          .to = "slider",
          .placement = {.R = rotation_between(Axis::kZ, Axis::kX)},
          .cut = true,
          .to_placement = {.R = rotation_between(Axis::kZ, Axis::kX)},
          .clearance = guide};
}

/// Crank and rod in line along x, the crank at 150 rad/s, free to go on.
Linkage make_published(double e, double mu) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_uniform("crank", 0.038, kCrankOfTwo, 7.4e-5),
                    make_uniform("rod", 0.038, kRodOfTwo, 5.9e-4),
                    make_uniform("slider", 0.076, 0.0, 2.7e-6)};
  linkage.joints = {
      {.name = "crank", .from = kGroundName, .to = "crank", .placement = {}},
      {.name = "pin", .from = "crank", .to = "rod", .placement = {.p = {kCrankOfTwo, 0.0, 0.0}}},
      {.name = "end", .from = "rod", .to = "slider", .placement = {.p = {kRodOfTwo, 0.0, 0.0}}},
      make_guide_joint(make_guide(e, mu))};
  linkage.joints[0].freedoms = {{.name = "crank", .start = 0.0, .start_rate = 150.0}};
  linkage.joints[1].freedoms = {{.name = "pin", .start = 0.0, .start_rate = -225.0}};
  linkage.joints[2].freedoms = {{.name = "end", .start = 0.0, .start_rate = 75.0}};
  return linkage;
}

/// A value between samples of 10 us.
double find_value_at(const RunResult& run, const char* key, double t) {
  const double place = t * 1e5;
  const auto before = static_cast<std::size_t>(place);
  const std::vector<double>& values = column(run, key);
  const double part = place - static_cast<double>(before);
  return values[before] + (part > 1e-9 ? part * (values[before + 1] - values[before]) : 0.0);
}

double find_first_touch(const RunResult& run) {
  const std::vector<double>& force = column(run, "guide_contact_force_n");
  std::size_t k = 0;
  while (force[k] == 0.0) ++k;
  return column(run, "t_s")[k];
}

struct PublishedRow {
  double t;            ///< [ms]
  double revolutions;  ///< of the crank
  double speed;        ///< of the crank, [rad/s]
};

void add_published_row(Findings& findings, const RunResult& smooth, const PublishedRow& row) {
  constexpr const char* kWhy = "rigid impacts there, stiff ones here; steps of first order there";
  const std::string at = " at " + std::to_string(row.t).substr(0, 5) + " ms, e = 0.1, without friction";
  findings.checks.push_back(
      compare("revolutions of the crank" + at, kSiconosSource,
              find_value_at(smooth, "crank_rad", 1e-3 * row.t) / (2.0 * std::numbers::pi), row.revolutions,
              1e-3 * row.revolutions, "1", kWhy));
  findings.checks.push_back(compare("speed of the crank" + at, kSiconosSource,
                                    find_value_at(smooth, "crank_rad_s", 1e-3 * row.t), row.speed,
                                    1e-3 * row.speed, "rad/s", kWhy));
}

}  // namespace

Findings compute_published_slider_crank() {
  Findings findings;
  const RunResult smooth = run_linkage(make_published(0.1, 0.0), Integrator::kRadau5, 0.04, 1e5);
  findings.checks.push_back(compare("instant at which the slider meets its guide", kSiconosSource,
                                    1e3 * find_first_touch(smooth), 2.6925, 0.01, "ms", "a sample"));
  constexpr PublishedRow kSmooth[] = {{2.69, 0.05650488471, 109.5930022},
                                      {10.02, 0.1510954405, 67.46421919},
                                      {20.1, 0.2579660784, 71.95167890},
                                      {40.0, 0.6268918408, 114.1025750}};
  for (const PublishedRow& row : kSmooth) add_published_row(findings, smooth, row);
  return findings;
}

}  // namespace validation
