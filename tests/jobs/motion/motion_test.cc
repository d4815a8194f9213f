// SPDX-License-Identifier: Apache-2.0
// Spectra, sections and exponents of motions whose answers are known.

#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/motion/lyapunov.h"
#include "jobs/motion/poincare.h"
#include "jobs/motion/spectrum.h"

namespace jobs_tests {
namespace {

using jobs::Window;
using std::numbers::pi;

/// 1 + 2 sin(2 pi 50 t) + 0.5 cos(2 pi 120 t), 1000 samples a second.
std::vector<double> two_sines(std::size_t count) {
  std::vector<double> samples;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / 1000.0;
    samples.push_back(1.0 + 2.0 * std::sin(2.0 * pi * 50.0 * t) + 0.5 * std::cos(2.0 * pi * 120.0 * t));
  }
  return samples;
}

TEST(CalcSpectrum, HasTheAmplitudesOfASumOfSines) {
  for (const Window window : {Window::kHann, Window::kFlatTop, Window::kRectangular}) {
    const auto spectrum = jobs::calc_spectrum(two_sines(1000), 1000.0, window);
    ASSERT_EQ(spectrum.frequency.size(), 501U);
    EXPECT_EQ(spectrum.frequency[50], 50.0);
    EXPECT_NEAR(spectrum.amplitude[0], 1.0, 1e-12);
    EXPECT_NEAR(spectrum.amplitude[50], 2.0, 1e-7);  // the flat top's coefficients have so many digits
    EXPECT_NEAR(spectrum.amplitude[120], 0.5, 1e-7);
    EXPECT_NEAR(spectrum.amplitude[300], 0.0, 1e-7);
  }
}

TEST(CalcSpectrum, HasTheVarianceUnderItsDensity) {
  for (const Window window : {Window::kHann, Window::kFlatTop, Window::kRectangular}) {
    const auto spectrum = jobs::calc_spectrum(two_sines(1000), 1000.0, window);
    EXPECT_NEAR(std::accumulate(spectrum.density.begin(), spectrum.density.end(), 0.0) * 1.0,
                2.0 * 2.0 / 2.0 + 0.5 * 0.5 / 2.0, 1e-9);
  }
}

// Between two lines a flat top keeps the amplitude within 0.01 dB (Heinzel, Ruediger and Schilling 2002); a
// rectangle would show 2/pi of it.
TEST(CalcSpectrum, MeasuresBetweenTheLinesWithAFlatTop) {
  std::vector<double> samples;
  for (int k = 0; k < 1000; ++k) samples.push_back(3.0 * std::sin(2.0 * pi * 50.5 * k / 1000.0));
  EXPECT_NEAR(jobs::calc_spectrum(samples, 1000.0, Window::kFlatTop).amplitude[50], 3.0,
              3.0 * (1.0 - std::pow(10.0, -0.01 / 20.0)));
  EXPECT_NEAR(jobs::calc_spectrum(samples, 1000.0, Window::kRectangular).amplitude[50], 3.0 * 2.0 / pi, 0.03);
}

TEST(CalcSpectrum, LeavesSamplesOutRatherThanTransformAPrimeNumberOfThem) {
  EXPECT_EQ(jobs::calc_spectrum(two_sines(1009), 1000.0, Window::kHann).frequency.size(), 1000U / 2 + 1);
}

engine::Trajectory run_of(const std::vector<std::string>& keys, std::vector<std::vector<double>> columns) {
  engine::Trajectory run;
  for (const std::string& key : keys) run.channels.push_back({.key = key, .help = ""});
  run.columns = std::move(columns);
  return run;
}

TEST(MakeSpectrum, LeavesOutASampleThatIsOffTheRate) {
  std::vector<double> t;
  for (int k = 0; k < 100; ++k) t.push_back(k / 1000.0);
  t.push_back(0.0993);
  const auto spectrum = make_spectrum(run_of({"t_s", "a_m"}, {t, two_sines(101)}), Window::kHann);
  EXPECT_EQ(spectrum.channels[2].key, "a_m_squared_per_hz");
  EXPECT_EQ(spectrum.columns[0].size(), 51U);
  EXPECT_NEAR(spectrum.columns[0].back(), 500.0, 1e-9);
  EXPECT_THROW((void)make_spectrum(run_of({"t_s", "a_m"}, {{0, 1}, {0, 1}}), Window::kHann),
               jobs::WrongState);
  EXPECT_THROW(
      (void)make_spectrum(run_of({"t_s", "a_m"}, {t, std::vector<double>(101, std::nan(""))}), Window::kHann),
      jobs::WrongState);
}

// The crank turns 3 rad/s and is past a whole number of turns and 1 rad at (1 + 2 pi k) / 3 s; x = 7 t is
// known there.
TEST(TakeSection, HasTheInstantsAtWhichTheCrankPasses) {
  std::vector<double> t, angle, x;
  for (int k = 0; k <= 700; ++k) {
    t.push_back(k / 100.0);
    angle.push_back(3.0 * t.back());
    x.push_back(7.0 * t.back());
  }
  const auto section = jobs::take_section(run_of({"t_s", "crank_angle_rad", "x_mm"}, {t, angle, x}), 1.0);
  ASSERT_EQ(section.columns[0].size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const double passed = (1.0 + 2.0 * pi * static_cast<double>(k)) / 3.0;
    EXPECT_NEAR(section.columns[0][k], passed, 1e-12);
    EXPECT_EQ(section.columns[1][k], static_cast<double>(k));
    EXPECT_NEAR(section.columns[2][k], 7.0 * passed, 1e-12);
  }
  EXPECT_EQ(section.channels[2].key, "x_mm");
  for (double& a : angle) a = -a;
  EXPECT_EQ(
      jobs::take_section(run_of({"t_s", "crank_angle_rad", "x_mm"}, {t, angle, x}), 1.0).columns[0].size(),
      3U)
      << "backwards";
}

/// x' = 4 x (1 - x), whose exponent is ln 2 a step.
std::vector<double> logistic(double x, int steps) {
  std::vector<double> values;
  for (int k = 0; k < steps; ++k, x = 4.0 * x * (1.0 - x)) values.push_back(x);
  return values;
}

TEST(MeasureDivergence, FindsTheExponentOfTheLogisticMap) {
  std::vector<double> t;
  for (int k = 0; k < 60; ++k) t.push_back(0.5 * k);  // two steps a second: 2 ln 2 per second
  double sum = 0.0;
  constexpr int kPairs = 400;
  for (int pair = 0; pair < kPairs; ++pair) {
    const double x = 0.1 + 0.8 * std::fmod(0.6180339887 * pair, 1.0);
    const auto divergence = jobs::measure_divergence(t, {logistic(x, 60)}, {logistic(x + 1e-8, 60)});
    ASSERT_TRUE(divergence.has_value());
    EXPECT_LT(divergence->from, divergence->to);
    sum += divergence->exponent / kPairs;
  }
  // The slope of one pair scatters by 0.16 (the map stretches by 4 |1 - 2x| here and there), the mean of 400
  // by 0.008; since the stretch ends where the distance first is a tenth of the motion, it is 3 % low.
  EXPECT_NEAR(sum, 2.0 * std::log(2.0), 0.06);
}

TEST(MeasureDivergence, IsExactWhereTheDistanceGrowsByAFactor) {
  std::vector<double> t, a, b;
  for (int k = 0; k <= 400; ++k) {
    t.push_back(k / 100.0);
    a.push_back(std::sin(t.back()));
    b.push_back(a.back() + 1e-7 * std::exp(5.0 * t.back()));
  }
  EXPECT_NEAR(jobs::measure_divergence(t, {a}, {b})->exponent, 5.0, 1e-6);
}

TEST(MeasureDivergence, IsEmptyWhereNeighboursStayTogether) {
  std::vector<double> t, a, b;
  for (int k = 0; k <= 400; ++k) {
    t.push_back(k / 100.0);
    a.push_back(std::sin(t.back()));
    b.push_back(std::sin(t.back() + 1e-3));
  }
  EXPECT_FALSE(jobs::measure_divergence(t, {a}, {b}).has_value());
  EXPECT_FALSE(jobs::measure_divergence(t, {a}, {a}).has_value());
}

}  // namespace
}  // namespace jobs_tests
