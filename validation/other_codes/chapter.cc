// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "validation/chapters.h"
#include "validation/reference/steel_links.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/largest.h"
#include "validation/support/runs.h"

namespace validation {

namespace {

struct SimbodyRow {
  std::size_t ms;
  double slider_position_m, slider_velocity_m_s, journal_x_mm, journal_y_mm;
};

// The same case by Simbody 3.7 (Merson's method, accuracy 1e-9): the second geometry, rigid, 0.25 mm, 10
// rad/s, links as exact solids of steel. First contact at 5.8 ms.
constexpr SimbodyRow kSimbody[] = {
    {1, 6.582575694720e-01, -7.056138884540e-08, -2.487872900e-06, 7.356948414e-03},
    {3, 6.582575688582e-01, -6.372127550174e-07, -7.009224276e-05, 6.621254566e-02},
    {5, 6.582575665448e-01, -1.770154980095e-06, -3.379942881e-04, 1.839237672e-01},
    {7, 6.582576188169e-01, 4.715663390664e-05, -8.126849263e-04, 1.755962191e-01},
    {10, 6.582577557981e-01, 4.386138517943e-05, -2.242413138e-03, 5.381317306e-02},
    {50, 6.584363901057e-01, 1.278219521076e-02, -1.317697937e-01, 1.991671671e-01},
};
constexpr std::size_t kFirstContactMs = 6;

struct ComparedChannel {
  const char* key;
  const char* name;
  const char* unit;
  double SimbodyRow::*value;
  double bound_before, bound_after;
  const char* why_before;
};

constexpr ComparedChannel kChannels[] = {
    {"slider_position_m", "slider position", "m", &SimbodyRow::slider_position_m, 2e-13, 2e-11,
     "rounding of lengths near 1 m"},
    {"slider_velocity_m_s", "slider velocity", "m/s", &SimbodyRow::slider_velocity_m_s, 1e-9, 2e-8,
     "the accuracy asked of Simbody"},
    {"journal_x_mm", "journal centre, x in the bearing", "mm", &SimbodyRow::journal_x_mm, 1e-10, 2e-8,
     "rounding of lengths near 1 m"},
    {"journal_y_mm", "journal centre, y in the bearing", "mm", &SimbodyRow::journal_y_mm, 1e-10, 1e-7,
     "rounding of lengths near 1 m"},
};

double largest_difference(const RunResult& run, const ComparedChannel& channel, bool before) {
  Largest largest;
  for (const SimbodyRow& row : kSimbody)
    if ((row.ms < kFirstContactMs) == before)
      largest.take(column(run, channel.key)[row.ms] - row.*channel.value);
  return largest.value();
}

Findings first_milliseconds_of_simbody() {
  RpsupParameters parameters = across_rpsup();
  parameters.links = steel_links();  // as that model has them
  const RunResult run = run_rpsup(parameters, {.duration = 0.05, .integrator = Integrator::kDopri5,
                                               .relative_tolerance = 1e-9, .absolute_tolerance = 1e-12});
  Findings findings;
  for (const ComparedChannel& channel : kChannels) {
    const std::string what = std::string(channel.name) + ", second geometry, rigid, 0.25 mm, 10 rad/s, ";
    findings.checks.push_back(limit(what + "before the first contact (1, 3, 5 ms)",
                                    "Simbody 3.7, accuracy 1e-9", largest_difference(run, channel, true),
                                    channel.bound_before, channel.unit, channel.why_before));
    findings.checks.push_back(
        limit(what + "after it (7, 10, 50 ms)", "Simbody 3.7, accuracy 1e-9",
              largest_difference(run, channel, false), channel.bound_after, channel.unit,
              "each code finds the instant of contact in its own way; impacts multiply the difference"));
  }
  return findings;
}

Findings peak_of_six_codes() {
  RpsupParameters parameters = across_rpsup();
  parameters.links = steel_links();  // as those models have them
  const RunResult run = run_rpsup(parameters, {.duration = 4.0, .integrator = Integrator::kDopri5,
                                               .relative_tolerance = 1e-8, .absolute_tolerance = 1e-9});
  const RunResult by_default = run_rpsup(parameters, {.duration = 4.0});
  const std::string linkage = "second geometry, rigid, 0.25 mm, 10 rad/s, links as solids of steel";
  return {.checks = {
              compare("peak slider acceleration in 4 s, " + linkage,
                      "six independent multibody codes: 772.6 m/s\u00b2",
                      metric(run, "peak_slider_acceleration_m_s2"), 772.6, 0.051, "m/s\u00b2",
                      "half of the last of the four digits they agree on, and rounding"),
              compare("time of that peak, " + linkage, "six independent multibody codes: 3.6434 s",
                      metric(run, "peak_slider_acceleration_time_s"), 3.6434, 1e-4, "s",
                      "the digits they agree on"),
              compare("the same peak by the default integrator and tolerances, " + linkage,
                      "six independent multibody codes: 772.6 m/s\u00b2",
                      metric(by_default, "peak_slider_acceleration_m_s2"), 772.6, 0.7726, "m/s\u00b2",
                      "a thousandth"),
          }};
}

struct OtherPeak {
  Coupler coupler;
  const char* code;
  double peak;  ///< [m/s^2]
};

// By `script/bench codes`: MuJoCo's RK4 with steps of 1e-5 s, Simbody's Merson at an accuracy of 1e-6; 0.25
// mm, 10 rad/s.
constexpr OtherPeak kOtherPeaks[] = {{Coupler::kRigid, "MuJoCo 2.2.2", 39.1114},
                                     {Coupler::kRigid, "Simbody 3.7", 39.1113},
                                     {Coupler::kFlexible, "MuJoCo 2.2.2", 44.5644}};

Findings peaks_of_mujoco_and_simbody() {
  Findings findings;
  for (const OtherPeak& other : kOtherPeaks) {
    RpsupParameters parameters;
    parameters.coupler = other.coupler;
    const std::string coupler = other.coupler == Coupler::kRigid ? "rigid" : "flexible";
    const RunResult run = run_rpsup(parameters, {.duration = 4.0});
    findings.checks.push_back(
        compare("peak slider acceleration in 4 s, the study's geometry, " + coupler + ", 0.25 mm, 10 rad/s",
                other.code, metric(run, "peak_slider_acceleration_m_s2"), other.peak, 1e-3 * other.peak,
                "m/s\u00b2", "a thousandth"));
  }
  return findings;
}

}  // namespace

Chapter other_codes_chapter() {
  return {.name = "other_codes",
          .title = "Other codes",
          .text = R"(General multibody programs that share no line with this one run the whole model. MuJoCo
and Simbody run the paper's linkage (`script/bench codes`). Six codes, whose names are not recorded, ran the
second geometry: the cross link turns across the guide, the crank's axis is level, the guide lies 0.2 m
beside it, and the rod rises by 0.05 m from 0.2 m on by the cycloidal law.)",
          .parts = {{.name = "first_milliseconds_of_simbody", .compute = first_milliseconds_of_simbody},
                    {.name = "peak_of_six_codes", .compute = peak_of_six_codes},
                    {.name = "peaks_of_mujoco_and_simbody", .compute = peaks_of_mujoco_and_simbody}}};
}

}  // namespace validation
