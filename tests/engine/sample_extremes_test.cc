// SPDX-License-Identifier: Apache-2.0
// Channels of the least and largest value between samples: no curve that they bound is below its metric.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "engine/analysis/run_channels.h"
#include "engine/analysis/sample_extremes.h"
#include "engine/simulate_linkage.h"
#include "engine/simulate_rpsup.h"
#include "tests/engine/linkage_cases.h"

namespace engine {
namespace {

/// Columns of a quantity and of its extremes.
struct Sampled {
  std::string key;
  std::vector<double> values, least, largest;
};

/// The quantities of a run that have channels of their extremes.
std::vector<Sampled> find_sampled(const Trajectory& run) {
  std::vector<Sampled> found;
  for (std::size_t k = 1; k + 1 < run.channels.size(); ++k) {
    const std::string& key = run.channels[k].key;
    const std::size_t at = key.find("_min_");
    if (at == std::string::npos) continue;
    const std::string stem = key.substr(0, at), unit = key.substr(at + 4);
    EXPECT_EQ(run.channels[k - 1].key, stem + unit);
    EXPECT_EQ(run.channels[k + 1].key, stem + "_max" + unit);
    found.push_back({stem + unit, run.columns[k - 1], run.columns[k], run.columns[k + 1]});
  }
  return found;
}

double magnitude_of(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Each interval's extremes bound the samples at its ends. @returns the largest magnitude of the extremes
double check_bounds(const Sampled& quantity) {
  for (std::size_t k = 0; k < quantity.values.size(); ++k) {
    const auto [low, high] = std::minmax(quantity.values[k], quantity.values[k > 0 ? k - 1 : 0]);
    EXPECT_LE(quantity.least[k], low) << quantity.key << " at sample " << k;
    EXPECT_GE(quantity.largest[k], high) << quantity.key << " at sample " << k;
  }
  return std::max(magnitude_of(quantity.least), magnitude_of(quantity.largest));
}

/// The metrics of a quantity's largest magnitude in the whole run, which follow each other.
struct PeakMetrics {
  double magnitude, time;
};

/// @returns none without such metrics
std::optional<PeakMetrics> find_peak(std::string key, std::span<const QuantityInfo> table,
                                     const std::vector<double>& metrics) {
  for (const std::string_view unit : {"_m_s2", "_rad_s2"}) {
    const std::size_t end = key.size() - std::min(key.size(), unit.size());
    if (!key.ends_with(unit) || key.ends_with("accelerometer_m_s2")) continue;
    const bool is_named = key.find("_acceleration_") != std::string::npos;
    key.insert(end, is_named ? "_whole_run" : "_acceleration_whole_run");
    break;
  }
  for (std::size_t k = 0; k < table.size(); ++k)
    if (table[k].key == "peak_" + key) return PeakMetrics{metrics[k], metrics[k + 1]};
  return std::nullopt;
}

/// The peak lies in an interval between samples whose extreme has its magnitude.
void check_time(const Sampled& quantity, const std::vector<double>& t, const PeakMetrics& peak) {
  const auto later = std::ranges::lower_bound(t, peak.time);
  ASSERT_NE(later, t.end()) << quantity.key;
  const auto k = static_cast<std::size_t>(later - t.begin());
  EXPECT_DOUBLE_EQ(std::max(std::abs(quantity.least[k]), std::abs(quantity.largest[k])), peak.magnitude)
      << quantity.key << " at " << peak.time << " s";
}

/// Each metric of a largest magnitude is followed by the one of its time.
void check_times_follow(std::span<const QuantityInfo> table) {
  int peaks = 0;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const std::string& key = table[k].key;
    const bool is_peak =
        key.starts_with("peak_") || key.starts_with("max_") || key.starts_with("ideal_peak_");
    if (!is_peak || key.ends_with("_time_s")) continue;
    ASSERT_LT(k + 1, table.size()) << key;
    EXPECT_TRUE(table[k + 1].key.ends_with("_time_s")) << key;
    EXPECT_TRUE(("Time of " + key).starts_with(table[k + 1].help)) << table[k + 1].help;
    ++peaks;
  }
  EXPECT_GT(peaks, 5);
}

TEST(PeakMetrics, AreFollowedByTheirTimes) {
  check_times_follow(metric_table());
  check_times_follow(linkage_tables(make_loose_loops({})).metrics);
}

// An ideal joint has no contact, and a prescribed crank no current.
TEST(PeakMetrics, HaveNoTimeWithoutAPeak) {
  RpsupParameters ideal;
  ideal.c_r = 0.0;
  const RunResult run = simulate_rpsup(ideal, {.duration = 0.1}, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  const auto table = metric_table();
  int without = 0;
  for (std::size_t k = 0; k + 1 < table.size(); ++k) {
    if (!table[k + 1].key.ends_with("_time_s")) continue;
    const bool has_time = !std::isnan(run.metrics[k + 1]);
    EXPECT_EQ(has_time, run.metrics[k] > 0.0) << table[k].key;
    if (!has_time) ++without;
  }
  EXPECT_GE(without, 4);
}

TEST(SampleExtremes, TakesEndsSamplesAndTheCurveInsideAPart) {
  SampleExtremes values;
  values.restart(1.0);
  values.take_step(1.0, 1.0);
  values.take_curve(StepQuadratic(1.0, 1.0, 3.0, 1.0));  // 1 + 12 s (1 - s): 4 in the middle
  values.take_part(0.0, 0.25);
  EXPECT_DOUBLE_EQ(values.largest(), 1.0);
  values.take_part(0.25, 0.75);
  EXPECT_DOUBLE_EQ(values.largest(), 4.0);
  values.restart(2.0);
  values.take_part(0.75, 1.0);
  EXPECT_DOUBLE_EQ(values.least(), 1.0);
  EXPECT_DOUBLE_EQ(values.largest(), 2.0);
}

// Samples each 5 ms meet few impacts, samples at 50 kHz stand several in a step.
TEST(SampleExtremes, HoldThePeaksOfAnRpsup) {
  for (const double rate : {200.0, 50e3}) {
    const RunResult run = simulate_rpsup({}, {.duration = 0.3, .output_rate = rate}, {});
    ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
    int with_peak = 0;
    for (const Sampled& quantity : find_sampled(run.trajectory)) {
      const double extreme = check_bounds(quantity);
      const auto peak = find_peak(quantity.key, metric_table(), run.metrics);
      if (!peak || std::isnan(peak->magnitude)) continue;
      EXPECT_DOUBLE_EQ(extreme, peak->magnitude) << quantity.key;
      check_time(quantity, run.trajectory.columns[0], *peak);
      ++with_peak;
      if (rate < 1e3) {
        EXPECT_LT(magnitude_of(quantity.values), 0.95 * peak->magnitude) << quantity.key;
      }
    }
    EXPECT_EQ(with_peak, 5);  // acceleration, contact, torque, force, reaction
  }
}

TEST(SampleExtremes, AreNullOfAContactThatIsNone) {
  RpsupParameters parameters;
  parameters.c_r = 0.0;
  const RunResult run = simulate_rpsup(parameters, {.duration = 0.1}, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  int with_contact = 0;
  for (std::size_t k = 0; k < run.trajectory.channels.size(); ++k) {
    const std::string& key = run.trajectory.channels[k].key;
    if (!key.starts_with("contact_force_") && !key.starts_with("friction_force_")) continue;
    ++with_contact;
    for (const double value : run.trajectory.columns[k]) EXPECT_TRUE(std::isnan(value)) << key;
  }
  EXPECT_EQ(with_contact, 6);
}

// Springs, drives, reactions and contacts of two loops.
TEST(SampleExtremes, HoldThePeaksOfADescribedLinkage) {
  const Linkage linkage = make_loose_loops({});
  const RunResult run = simulate_linkage(linkage, {.duration = 0.3, .output_rate = 200.0}, 0.0, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  const std::vector<QuantityInfo> metrics = linkage_tables(linkage).metrics;
  const std::vector<Sampled> quantities = find_sampled(run.trajectory);
  EXPECT_GT(quantities.size(), 10U);
  for (const Sampled& quantity : quantities) {
    const auto peak = find_peak(quantity.key, metrics, run.metrics);
    ASSERT_TRUE(peak) << quantity.key;
    EXPECT_DOUBLE_EQ(check_bounds(quantity), peak->magnitude) << quantity.key;
    check_time(quantity, run.trajectory.columns[0], *peak);
  }
}

}  // namespace
}  // namespace engine
