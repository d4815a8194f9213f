// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "validation/kinematics/parts.h"
#include "validation/reference/ideal_linkage.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/largest.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

struct Case {
  std::string name;
  RpsupParameters parameters;
};

Case make_case(
    const std::string& name, double crank_velocity,
    void (*change)(RpsupParameters&) = [](RpsupParameters&) {}, RpsupParameters p = {}) {
  p.c_r = 0.0;
  p.crank_velocity = crank_velocity;
  change(p);
  return {number(crank_velocity) + " rad/s" + name, p};
}

std::vector<Case> make_cases() {
  std::vector<Case> cases;
  for (const double crank_velocity : {5.0, 10.0, 12.0, 15.0}) cases.push_back(make_case("", crank_velocity));
  cases.push_back(make_case(", guide at y = 0.06 m, z = -0.31 m", 10.0, [](RpsupParameters& p) {
    p.guide_offset_y = 0.06;
    p.guide_offset_z = -0.31;
  }));
  cases.push_back(make_case(", guide turned by 0.25 rad, crank from 0.4 rad on, rod by the parabolic law",
                            10.0, [](RpsupParameters& p) {
                              p.guide_angle = 0.25;
                              p.crank_start = 0.4;
                              p.rod_law = StrokeLaw::kParabolic;
                            }));
  for (const double crank_velocity : {10.0, 15.0})
    cases.push_back(make_case(
        ", second geometry, rod by the cycloidal law", crank_velocity, [](RpsupParameters&) {},
        across_rpsup()));
  cases.push_back(make_case(", yoke across the guide at y = -0.1 m, z = 0", 12.0, [](RpsupParameters& p) {
    p.yoke_axis = YokeAxis::kAcross;
    p.guide_offset_y = -0.1;
    p.guide_offset_z = 0.0;
  }));
  cases.push_back(make_case(", yoke across the guide turned by -0.2 rad, rod by the parabolic law", 12.0,
                            [](RpsupParameters& p) {
                              p.yoke_axis = YokeAxis::kAcross;
                              p.guide_angle = -0.2;
                              p.rod_law = StrokeLaw::kParabolic;
                            }));
  return cases;
}

/// Largest |acceleration| of the closed form in [from, to], on both sides of its jumps: sampled, and sampled
/// finer around each sample that comes near the largest.
double find_peak(const RpsupParameters& p, double from, double to) {
  constexpr double kCoarse = 1e-3;
  constexpr int kFine = 500;
  const auto magnitude = [&](double t) {
    return std::max(std::abs(calc_slider(p, t).derivative(2)),
                    std::abs(calc_slider(p, t, Side::kBefore).derivative(2)));
  };
  const auto samples = static_cast<int>(std::lround((to - from) / kCoarse));
  std::vector<double> sampled;
  for (int k = 0; k <= samples; ++k) sampled.push_back(magnitude(from + k * kCoarse));
  double peak = *std::max_element(sampled.begin(), sampled.end());
  const double contender = 0.999 * peak;  // between samples it grows by 1e-4 at most
  for (int k = 0; k < samples; ++k) {
    if (std::max(sampled[static_cast<std::size_t>(k)], sampled[static_cast<std::size_t>(k) + 1]) < contender)
      continue;
    for (int i = 1; i < kFine; ++i)
      peak = std::max(peak, magnitude(from + (k + static_cast<double>(i) / kFine) * kCoarse));
  }
  return peak;
}

/// Largest difference of a channel from a derivative of the slider's closed form. A sample at a jump is from
/// before it.
double compare_channel(const RunResult& run, const RpsupParameters& p, const char* key, std::size_t order) {
  const std::vector<double>& t = column(run, "t_s");
  const std::vector<double>& found = column(run, key);
  Largest worst;
  for (std::size_t k = 0; k < t.size(); ++k)
    worst.take(found[k] - calc_slider(p, t[k], Side::kBefore).derivative(order));
  return worst.value();
}

}  // namespace

Findings compute_closed_form() {
  Findings findings;
  Table table{
      .caption = "The ideal rigid linkage over 5 s, sampled each millisecond, against the closed form.",
      .head = {"case", "position, largest difference [m]", "velocity [m/s]", "acceleration [m/s^2]"},
      .rows = {},
      .reproducible_to = 10.0};
  Table peaks{.caption = "Peak slider acceleration of the ideal rigid linkage for t >= 2 s, [m/s^2].",
              .head = {"case", "closed form", "from the run's steps", "from the search for it"},
              .rows = {}};
  const std::string reference =
      "z = S . d + sqrt(l^2 - |S - (S . d) d|^2), S from the guide to the S joint, d along the guide, with "
      "derivatives by Taylor arithmetic";
  for (const auto& [name, p] : make_cases()) {
    const RunResult run = run_rpsup(p, {});
    const std::string at = std::string(", ideal rigid linkage, ") + name;
    const double z = compare_channel(run, p, "slider_position_m", 0);
    const double v = compare_channel(run, p, "slider_velocity_m_s", 1);
    const double a = compare_channel(run, p, "slider_acceleration_m_s2", 2);
    findings.checks.push_back(limit("slider position" + at, reference, z, 1e-12, "m",
                                    "Newton's method closes the loop to 1e-13 m"));
    findings.checks.push_back(
        limit("slider velocity" + at, reference, v, 1e-11, "m/s", "1e-13 m at rates of up to 50 1/s"));
    findings.checks.push_back(limit("slider acceleration" + at, reference, a, 1e-9, "m/s^2",
                                    "1e-13 m at squared rates of up to 2,500 1/s^2"));

    const double peak = find_peak(p, p.run_up, 5.0);
    const double of_steps = metric(run, "peak_slider_acceleration_m_s2");
    const double searched = metric(run, "ideal_peak_slider_acceleration_m_s2");
    const std::string sampled = "largest of the closed form, sampled each 2 us where it is near its largest";
    findings.checks.push_back(compare("peak acceleration for t >= 2 s" + at, sampled, of_steps, peak,
                                      1e-8 * peak, "m/s^2",
                                      "steps of 0.25 ms with a quadratic in each: (15 rad/s x 0.25 ms)^4 of "
                                      "the peak, and more of its harmonics"));
    findings.checks.push_back(compare("peak acceleration found by search (metric of the ideal peak)" + at,
                                      sampled, searched, peak, 1e-8 * peak, "m/s^2",
                                      "samples 2 us apart miss (omega 1e-6 s)^2 of the peak at most"));
    table.rows.push_back({name, number(z, 2), number(v, 2), number(a, 2)});
    peaks.rows.push_back({name, number(peak, 9), number(of_steps, 9), number(searched, 9)});
  }
  findings.tables = {std::move(table), std::move(peaks)};
  return findings;
}

}  // namespace validation
