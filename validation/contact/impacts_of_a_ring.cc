// SPDX-License-Identifier: Apache-2.0
// Differences between a ring of elements and the closed form in a single impact.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "validation/contact/parts.h"
#include "validation/contact/sliding_mass.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kRingMass = 0.8;    // [kg]
constexpr double kRingSpeed = 0.05;  // [m/s]

/// Rebound ratio of a ring of infinitely many elements, each with the damping of its own onset: f = s (x - y)
/// (1 + c v / v(y)), never negative, for the element that is met at the depth y. A shallow arc has elements
/// at equal distances of sqrt(y), so the ratio depends on c alone. By steps of its own: m v dv = -F dx has no
/// closed form here.
double ring_rebound(double c) {
  constexpr int kElements = 2000;
  constexpr double kStep = 2e-4;
  std::vector<double> met_at, rate;  // depth y and onset rate v(y) of each element
  for (int k = 0; k < kElements; ++k) met_at.push_back(std::pow(2.0 * (k + 0.5) / kElements, 2));
  rate.assign(met_at.size(), 0.0);
  const auto acceleration = [&](double x, double v) {
    double force = 0.0;
    for (std::size_t k = 0; k < met_at.size() && met_at[k] < x; ++k) {
      const double onset = rate[k] > 0.0 ? rate[k] : v;
      force += (x - met_at[k]) * std::max(0.0, 1.0 + c * v / onset);
    }
    return -force * 2.0 / kElements;
  };
  double x = 0.0;
  double v = 1.0;
  while (x >= 0.0) {  // the explicit midpoint rule
    const double x_middle = x + 0.5 * kStep * v;
    const double v_middle = v + 0.5 * kStep * acceleration(x, v);
    const double x_end = x + kStep * v_middle;
    const double v_end = v + kStep * acceleration(x_middle, v_middle);
    for (std::size_t k = 0; k < met_at.size(); ++k)
      if (rate[k] == 0.0 && x_end > met_at[k]) rate[k] = v + (v_end - v) * (met_at[k] - x) / (x_end - x);
    x = x_end;
    v = v_end;
  }
  return -v;
}

/// @param n_ce  0: the continuum
Impact simulate_ring_impact(int n_ce, double pitches, double speed = kRingSpeed, double k_r = 0.9) {
  ClearanceParameters joint = one_ring();
  joint.chi = 0.75 * (1.0 - k_r * k_r);
  const double time = calc_hertz_time(joint.K, kRingMass, speed);
  if (n_ce > 0) {
    joint.form = RadialForm::kElements;
    joint.n_ce = n_ce;
    joint.K /= std::sqrt(joint.r_b / joint.r_j());  // as stiff as the continuum in a shallow arc
  }
  return simulate_impact(
      make_sliding_mass(joint, kRingMass, n_ce > 0 ? pitches * 2.0 * std::numbers::pi / n_ce : 0.0), 20e-6,
      speed, time);
}

/// Rebound ratio of 1440 elements in the limit of a shallow arc: from two speeds, as the depth goes to zero.
double shallow_ring_rebound(double k_r) {
  const Impact fast = simulate_ring_impact(1440, 0.0, 0.05, k_r);
  const Impact slow = simulate_ring_impact(1440, 0.0, 0.02, k_r);
  const double e_fast = fast.speed / 0.05;
  const double e_slow = slow.speed / 0.02;
  return e_slow - (e_fast - e_slow) * slow.depth / (fast.depth - slow.depth);
}

Table make_ring_impact_table() {
  return {.caption =
              "One impact of a mass of 0.8 kg at 0.05 m/s, k_r = 0.9, no friction. Each element has the "
              "damping of its own onset, and those at the "
              "edge of the arc meet the bore later and slower: the rebound is 0.9119 in place of 0.9132. "
              "The ring's K is divided by "
              "sqrt(r_b / r_j), so that its stiffness is the continuum's.",
          .head = {"contact", "towards", "rebound ratio", "largest force [N]", "largest penetration [um]",
                   "contact time [us]"},
          .rows = {},
          .keys = 2};
}

void add_ring_impact(Table& table, const std::string& contact, const char* towards, const Impact& impact) {
  table.rows.push_back({contact, towards, number(impact.speed / kRingSpeed, 6), number(impact.force, 4),
                        number(1e6 * impact.depth, 4), number(1e6 * impact.contact_time, 5)});
}

Check compare_shallow_rebound(double k_r) {
  return compare(
      "rebound ratio of a ring of 1440 elements, k_r = " + number(k_r) + ", as the depth goes to zero",
      "a shallow arc of infinitely many elements, each with its own onset rate, by other steps",
      shallow_ring_rebound(k_r), ring_rebound(0.75 * (1.0 - k_r * k_r)), 3e-6, "1",
      "second order in the depth, and 1440 elements: 1e-6 each");
}

}  // namespace

Findings compute_impacts_of_a_ring() {
  Findings findings;
  Table table = make_ring_impact_table();
  add_ring_impact(table, "continuum", "", simulate_ring_impact(0, 0.0));
  for (const int n_ce : {36, 72, 180, 720})
    for (const double pitches : {0.0, 0.5})
      add_ring_impact(table, std::to_string(n_ce) + " elements",
                      pitches == 0.0 ? "an element" : "between two", simulate_ring_impact(n_ce, pitches));
  findings.tables.push_back(std::move(table));
  for (const double k_r : {0.9, 0.3}) findings.checks.push_back(compare_shallow_rebound(k_r));
  return findings;
}

}  // namespace validation
