// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "jobs/fits/divergence.h"
#include "jobs/fits/features.h"
#include "jobs/fits/observation.h"

namespace jobs_tests {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Sine at times whose steps differ by a fifth.
struct Sampled {
  std::vector<double> t, y;
};
Sampled sine(double hz, double end_s) {
  Sampled s;
  for (std::size_t k = 0; s.t.empty() || s.t.back() < end_s; ++k) {
    s.t.push_back(s.t.empty() ? 0.0 : s.t.back() + (k % 2 == 0 ? 0.9e-3 : 1.1e-3));
    s.y.push_back(std::sin(kTwoPi * hz * s.t.back()));
  }
  return s;
}

// |H|^2 = 1 / (1 + w^4) and the phase -atan2(sqrt(2) w, 1 - w^2), with w = f / f_c.
TEST(LowPass, HasButterworthsResponse) {
  const double hz = 4.0, cutoff = 5.0, w = hz / cutoff;
  const Sampled s = sine(hz, 3.0);
  const double gain = 1.0 / std::sqrt(1.0 + std::pow(w, 4.0));
  const double lag = std::atan2(std::numbers::sqrt2 * w, 1.0 - w * w);
  const auto filtered = jobs::filter_low_pass(s.t, s.y, cutoff);
  for (std::size_t k = s.t.size() / 2; k < s.t.size();
       ++k)  // a linear signal between samples: (2 pi f dt)^2 / 8
    ASSERT_NEAR(filtered[k], gain * std::sin(kTwoPi * hz * s.t[k] - lag), 2e-4);
}

TEST(LowPass, LeavesAConstantAsItIs) {
  const std::vector<double> t{0.0, 0.1, 0.4}, y{2.0, 2.0, 2.0};
  for (const double value : jobs::filter_low_pass(t, y, 3.0))
    EXPECT_NEAR(value, 2.0, 1e-15);
}

TEST(Sensor, DelaysScalesAndShifts) {
  const Sampled s = sine(2.0, 1.0);
  const std::vector<double> at{0.2, 0.51234, 0.9};
  const auto signal = jobs::predict_signal(s.t, s.y, {.gain = -3.0, .offset = 0.5, .delay_s = 0.05}, at);
  ASSERT_TRUE(signal);
  for (std::size_t k = 0; k < at.size(); ++k)
    EXPECT_NEAR((*signal)[k], 0.5 - 3.0 * std::sin(kTwoPi * 2.0 * (at[k] - 0.05)), 1e-5);
  EXPECT_FALSE(jobs::predict_signal(s.t, s.y, {.delay_s = 0.3}, at)) << "0.2 s is before the first sample";
}

TEST(Sensor, InterpolatesAParabolaExactlyByCubics) {
  const std::vector<double> t{0.0, 1.0, 1.5, 4.0}, y{0.0, 1.0, 2.25, 16.0}, at{0.0, 0.3, 1.2, 3.0, 4.0};
  const auto cubic = jobs::interpolate(t, y, at, jobs::Interpolation::kCubic);
  const auto linear = jobs::interpolate(t, y, at, jobs::Interpolation::kLinear);
  ASSERT_TRUE(cubic && linear);
  for (std::size_t k = 0; k < at.size(); ++k) EXPECT_NEAR((*cubic)[k], at[k] * at[k], 1e-12);
  EXPECT_NEAR((*linear)[1], 0.3, 1e-15);
}

TEST(MeasuredSignal, SelectsItsWindows) {
  const std::vector<double> t{0.0, 1.0, 2.0, 3.0}, y{0.0, 0.0, 0.0, 0.0};
  const jobs::MeasuredSignal measured{.t = t,
                                      .y = {1.0, -1.0, 1.0, 5.0},
                                      .fitted = {{0.0, 1.0}},
                                      .held_back = {{3.0, 9.0}},
                                      .sigma = 0.5};
  const auto fitted = jobs::calc_residuals(measured, jobs::Samples::kFitted, t, y, {});
  ASSERT_TRUE(fitted);
  EXPECT_EQ(*fitted, (std::vector<double>{-2.0, 2.0}));
  EXPECT_EQ(*jobs::calc_residuals(measured, jobs::Samples::kHeldBack, t, y, {}), std::vector<double>{-10.0});
}

// 20 cycles of 1 s: 3 sin(2 pi 10 t), with two samples of 50 in every fourth cycle, 20 ms apart.
TEST(Features, MatchTheirClosedForms) {
  std::vector<double> t, y;
  for (std::size_t k = 0; k < 20000; ++k) {
    t.push_back(1e-3 * static_cast<double>(k));
    y.push_back(3.0 * std::sin(kTwoPi * 10.0 * t.back()));
    if (k % 4000 == 500 || k % 4000 == 520) y.back() = 50.0;
  }
  const jobs::FeatureOptions options{
      .cycle_s = 1.0, .threshold = 10.0, .refractory_s = 0.05, .lowest_band_hz = 2.0, .bands = 4};
  const auto f = jobs::calc_features(t, y, options);
  ASSERT_EQ(f.size(), 8U + options.bands);
  EXPECT_NEAR(f[0], (5.0 * 50.0 + 15.0 * 3.0) / 20.0, 1e-6);
  EXPECT_NEAR(f[2], 3.0, 1e-6);
  EXPECT_NEAR(f[3], 50.0, 1e-6);
  EXPECT_NEAR(f[4], std::sqrt(4.5 + 10.0 * 2500.0 / 20000.0), 1e-3);
  EXPECT_NEAR(f[5], 5.0 / 20.0, 1e-4);
  EXPECT_NEAR(f[6], 3.0, 1e-6);
  EXPECT_NEAR(f[8 + 2], 3.0 / std::numbers::sqrt2, 0.1);  // 8 to 16 Hz
  EXPECT_LT(f[8 + 0], 0.2);
}

TEST(Features, ScatterOverReplicates) {
  const std::vector<std::vector<double>> replicates{{1.0, 5.0}, {3.0, 5.0}};
  const auto scatter = jobs::calc_scatter(replicates);
  EXPECT_EQ(scatter.mean, (std::vector<double>{2.0, 5.0}));
  EXPECT_NEAR(scatter.deviation[0], std::numbers::sqrt2, 1e-15);
  EXPECT_EQ(scatter.deviation[1], 0.0);
}

TEST(SignalDivergence, ChoosesTheBasisOfTheFit) {
  const Sampled s = sine(2.0, 1.0);
  auto near = s.y, far = s.y;
  for (double& y : near) y *= 1.01;
  for (double& y : far) y = -y;
  const auto converging = jobs::judge_divergence(std::vector{s.y, near});
  EXPECT_NEAR(converging.ratio, 0.01, 1e-6);
  EXPECT_EQ(converging.basis, jobs::FitBasis::kPointWise);
  const auto diverging = jobs::judge_divergence(std::vector{s.y, near, far});
  EXPECT_NEAR(diverging.ratio, 2.0, 1e-4);
  EXPECT_EQ(diverging.basis, jobs::FitBasis::kFeatures);
  EXPECT_NE(diverging.message.find("features"), std::string::npos);
}

}  // namespace
}  // namespace jobs_tests
