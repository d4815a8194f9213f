// SPDX-License-Identifier: Apache-2.0
// Crank, rod and cross link as beams: cut out of the linkage, sagging in it, and stiff in it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "validation/flexibility/links.h"
#include "validation/flexibility/parts.h"
#include "validation/flexibility/rods.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kLinkGravity = 9.81;  // [m/s^2]

LinkInertia& link_of(RpsupParameters& p, Link link) { return p.links[static_cast<std::size_t>(link)]; }

/// First frequency of a link clamped at its root, over that of Euler and Bernoulli's beam: (1.875 / l)^2
/// sqrt(E I l / m).
double calc_frequency_ratio(const FlexibleLink& link, int segments) {
  RpsupParameters p = with_flexible(link, segments);
  LinkInertia& inertia = link_of(p, link.link);
  inertia.inertia *=
      1e-4;  // hardly any rotary inertia; across the link the divided beam has that of its mass and length
  const double l = p.*link.length;
  const double beam = std::pow(1.8751040687119612 / l, 2) *
                      std::sqrt(calc_EI(p.*link.form) * l / inertia.mass) / (2.0 * std::numbers::pi);
  const Mechanism clamped = clamp_link(build_rpsup(p));
  return calc_frequencies(calc_mass_matrix(clamped), stiffness_matrix(clamped), {})[0] / beam;
}

/// Standing still with the crank along x, as far damped as it takes to come to rest.
RpsupParameters standing() {
  RpsupParameters p;
  p.c_r = 0.0;
  p.crank_velocity = 0.0;
  p.rod_stroke = 0.0;
  p.crank.damping_ratio = p.rod.damping_ratio = 1.0;
  return p;
}

/// Sag of a clamped beam's end under its own weight, an end load and an end moment: each joint, in the middle
/// of a segment, is bent by the moment there.
double calc_sag(double weight, double force, double moment, double l, double EI, int segments) {
  double sag = 0.0;
  for (int k = 0; k < segments; ++k) {
    const double arm = l * (1.0 - (k + 0.5) / segments);  // to the end
    sag += (0.5 * weight * arm * arm / l + force * arm + moment) * l / segments / EI * arm;
  }
  return sag;
}

/// [mm]
double find_sag(const RpsupParameters& p, const std::string& link) {
  const RunResult run = run_rpsup(p, {.duration = 0.15, .output_rate = 100.0});
  return column(run, link + "_deflection_mm").back();
}

void add_link_frequency(Findings& findings, Table& table, const FlexibleLink& link) {
  const double at_8 = calc_frequency_ratio(link, 8), at_16 = calc_frequency_ratio(link, 16),
               at_32 = calc_frequency_ratio(link, 32);
  const double coarse = (4.0 * at_16 - at_8) / 3.0, fine = (4.0 * at_32 - at_16) / 3.0;
  const double in_the_limit = (16.0 * fine - coarse) / 15.0;
  const std::string of = std::string(" of the clamped ") + link.name;
  findings.checks.push_back(
      compare("limit of the first frequency" + of + ", over the beam's", "Euler and Bernoulli's clamped beam",
              in_the_limit, 1.0, 1e-5, "1",
              "extrapolated from 8, 16 and 32 segments; the rotary inertia that is left"));
  findings.checks.push_back(compare("order of the error of the first frequency" + of + ", 8 to 32 segments",
                                    "2", std::log2((at_16 - at_8) / (at_32 - at_16)), 2.0, 0.05, "1",
                                    "terms of n^-4"));
  table.rows.push_back({link.name, number(calc_frequency_ratio(link, 3), 8), number(at_8, 8),
                        number(at_16, 8), number(at_32, 8), number(in_the_limit, 8)});
}

constexpr int kSagSegments = 16;
constexpr double kBallWeight = 0.5 * 0.306 * kLinkGravity;  // half of the coupler's, [N]
constexpr const char* kSagWhy =
    "second order in the slope, 3e-5 squared, and what still swings after 0.15 s";

/// The crank's end carries the rod, whose weight acts in the middle of the rod, and half of the coupler's.
Check compare_crank_sag() {
  RpsupParameters p = standing();
  p.crank.model = LinkModel::kFlexible;
  p.crank.elements = kSagSegments + 1;
  p.rod_length = p.rod_start = 0.3;  // its middle is 0.05 m before the crank's end, the ball 0.1 m beyond it
  link_of(p, Link::k12) = beam_inertia(0.6, 0.3, 3e-5);
  const double rod = 0.6 * kLinkGravity;
  const double sag = 1e3 * calc_sag(0.471 * kLinkGravity, rod + kBallWeight, -0.05 * rod + 0.1 * kBallWeight,
                                    0.2, calc_EI(p.crank), kSagSegments);
  return compare(
      "sag of the crank's end in the linkage at rest, under its weight, the rod's and half the "
      "coupler's, 16 segments",
      "moments over springs: F l^3 / (3 E I) and the like as n grows", find_sag(p, "crank"), sag, 1e-6 * sag,
      "mm", kSagWhy);
}

Check compare_rod_sag() {
  RpsupParameters p = standing();
  p.rod_start = p.rod_length;
  p.rod.model = LinkModel::kFlexible;
  p.rod.elements = kSagSegments + 1;
  const double sag =
      1e3 * calc_sag(0.490 * kLinkGravity, kBallWeight, 0.0, 0.2, calc_EI(p.rod), kSagSegments);
  return compare(
      "sag of the rod's end in the linkage at rest, under its weight and half the coupler's, 16 segments",
      "moments over springs: F l^3 / (3 E I) and the like as n grows", find_sag(p, "rod"), sag, 1e-6 * sag,
      "mm", kSagWhy);
}

/// Largest difference of the positions of slider and ball. [m]
double find_position_difference(const RunResult& one, const RunResult& other) {
  double largest = 0.0;
  for (const char* const key : {"slider_position_m", "pose_1_3_x_m", "pose_1_3_y_m"}) {
    const std::vector<double>& a = column(one, key);
    const std::vector<double>& b = column(other, key);
    for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  }
  return largest;
}

Check compare_stiff_link(const FlexibleLink& link) {
  const RunOptions options{.duration = 0.3, .output_rate = 100.0};
  RpsupParameters p = with_flexible(link, 3);
  p.c_r = 0.0;
  p.run_up = 0.1;
  p.youngs_modulus *= 1e4;
  p.shear_modulus *= 1e4;
  const RunResult flexible = run_rpsup(p, options);
  (p.*link.form).model = LinkModel::kRigid;
  const RunResult rigid = run_rpsup(p, options);
  return limit(std::string("slider and ball with a ") + link.name +
                   " ten thousand times as stiff as steel, over 0.3 s",
               "the same linkage with a rigid one", 1e6 * find_position_difference(flexible, rigid), 0.1,
               "um", "a bend of 1 mm / 10,000");
}

}  // namespace

Findings compute_link_frequencies() {
  Findings findings;
  Table table{.caption =
                  "First frequency of crank, rod and cross link (0.1 m), each cut out of the linkage and "
                  "clamped at its root, over that of "
                  "Euler and Bernoulli's beam.",
              .head = {"link", "3 segments", "8 segments", "16 segments", "32 segments", "limit"},
              .rows = {},
              .reproducible_to = 1e-6};
  for (const FlexibleLink& link : kFlexibleLinks) add_link_frequency(findings, table, link);
  findings.tables.push_back(std::move(table));
  return findings;
}

Findings compute_link_sags() {
  Findings findings;
  findings.checks = {compare_crank_sag(), compare_rod_sag()};
  return findings;
}

Findings compute_stiff_links() {
  Findings findings;
  for (const FlexibleLink& link : kFlexibleLinks) findings.checks.push_back(compare_stiff_link(link));
  return findings;
}

}  // namespace validation
