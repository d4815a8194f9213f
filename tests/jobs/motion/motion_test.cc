// SPDX-License-Identifier: Apache-2.0
// Spectra, sections and exponents of motions whose answers are known.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/motion/lyapunov.h"
#include "jobs/motion/poincare.h"
#include "jobs/motion/spectrum.h"

namespace jobs_tests {
namespace {

using ::testing::ElementsAre;

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
  const jobs::SectionChannels channels{.angle = "crank_angle_rad", .wanted = {"x_mm"}, .read = {}};
  const auto section =
      jobs::take_section(run_of({"t_s", "crank_angle_rad", "x_mm"}, {t, angle, x}), channels, 1.0);
  ASSERT_EQ(section.columns[0].size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const double passed = (1.0 + 2.0 * pi * static_cast<double>(k)) / 3.0;
    EXPECT_NEAR(section.columns[0][k], passed, 1e-12);
    EXPECT_EQ(section.columns[1][k], static_cast<double>(k));
    EXPECT_NEAR(section.columns[2][k], 7.0 * passed, 1e-12);
  }
  EXPECT_EQ(section.channels[2].key, "x_mm");
  for (double& a : angle) a = -a;
  const auto back =
      jobs::take_section(run_of({"t_s", "crank_angle_rad", "x_mm"}, {t, angle, x}), channels, 1.0);
  EXPECT_EQ(back.columns[0].size(), 3U) << "backwards";
}

/// A crank that turns by w t + a sin(3 t), a slider at sin(7 t), a journal at cos(5 t), and a force like it.
engine::Trajectory known_motion(double w, double a, double dt) {
  std::vector<std::vector<double>> columns(7);
  for (int k = 0; k * dt <= 40.0; ++k) {
    const double t = k * dt;
    const std::array<double, 7> row{t, w * t + a * std::sin(3.0 * t), w + 3.0 * a * std::cos(3.0 * t),
                                    std::sin(7.0 * t), 7.0 * std::cos(7.0 * t), -49.0 * std::sin(7.0 * t),
                                    std::cos(5.0 * t)};
    for (std::size_t c = 0; c < row.size(); ++c) columns[c].push_back(row[c]);
  }
  columns.push_back(columns.back());
  return run_of({"t_s", "crank_angle_rad", "crank_velocity_rad_s", "slider_position_m", "slider_velocity_m_s",
                 "slider_acceleration_m_s2", "journal_x_mm", "contact_force_n"},
                std::move(columns));
}

/// Largest errors of a section of that motion: instants, slider, journal, force.
std::array<double, 4> section_errors(double w, double a, double dt) {
  const jobs::SectionChannels channels{.angle = "crank_angle_rad",
                                       .wanted = {"slider_position_m", "journal_x_mm", "contact_force_n"},
                                       .read = {}};
  const auto section = jobs::take_section(known_motion(w, a, dt), channels, 1.0);
  std::array<double, 4> errors{};
  for (std::size_t k = 0; k < section.columns[0].size(); ++k) {
    const double passed = 1.0 + 2.0 * pi * section.columns[1][k];
    double t = section.columns[0][k];
    for (int n = 0; n < 20; ++n)
      t -= (w * t + a * std::sin(3.0 * t) - passed) / (w + 3.0 * a * std::cos(3.0 * t));
    const std::array<double, 4> exact{t, std::sin(7.0 * t), std::cos(5.0 * t), std::cos(5.0 * t)};
    for (std::size_t c = 0; c < 4; ++c)
      errors[c] = std::max(errors[c], std::abs(section.columns[c == 0 ? 0 : c + 1][k] - exact[c]));
  }
  return errors;
}

// The largest of 100 errors or more, each with its own place between two samples.
TEST(TakeSection, ConvergesWithTheOrderOfItsPolynomials) {
  const auto coarse = section_errors(17.0, 2.0, 0.02), fine = section_errors(17.0, 2.0, 0.01);
  EXPECT_NEAR(std::log2(coarse[0] / fine[0]), 4.0, 0.3) << "instants, by angle and velocity";
  EXPECT_NEAR(std::log2(coarse[1] / fine[1]), 4.0, 0.3) << "a position is no better than its instant";
  // A steady crank: the instants are exact, and each channel shows its own order.
  const auto steady = section_errors(17.0, 0.0, 0.02), finer = section_errors(17.0, 0.0, 0.01);
  EXPECT_LT(steady[0], 1e-13);
  EXPECT_NEAR(std::log2(steady[1] / finer[1]), 6.0, 0.3) << "with rate and acceleration";
  EXPECT_NEAR(std::log2(steady[2] / finer[2]), 4.0, 0.3) << "by four samples";
  EXPECT_NEAR(std::log2(steady[3] / finer[3]), 2.0, 0.3) << "by two samples";
}

TEST(TakeSection, KeepsWhatIsWantedOnly) {
  const jobs::SectionChannels channels{.angle = "crank_angle_rad", .wanted = {"journal_x_mm"}, .read = {}};
  const auto section = jobs::take_section(known_motion(17.0, 2.0, 0.01), channels, 1.0);
  ASSERT_EQ(section.channels.size(), 3U);
  EXPECT_EQ(section.channels[2].key, "journal_x_mm");
}

TEST(ChooseSection, ReadsTheDerivativesOfWhatIsWanted) {
  const std::vector<std::string> kept{
      "t_s",          "crank_angle_rad", "crank_velocity_rad_s", "slider_position_m", "slider_velocity_m_s",
      "journal_x_mm", "journal_y_mm",    "slider_acceleration_m_s2"};
  const auto slider = jobs::choose_section(kept, "", {"slider_position_m"});
  EXPECT_EQ(slider.angle, "crank_angle_rad");
  EXPECT_THAT(slider.read, ElementsAre("slider_position_m", "crank_angle_rad", "slider_velocity_m_s",
                                       "slider_acceleration_m_s2", "crank_velocity_rad_s"));
  EXPECT_THAT(jobs::choose_section(kept, "", {}).wanted, ElementsAre("journal_x_mm", "journal_y_mm"));
}

TEST(ChooseSection, TakesTheFirstFreedomThatTurnsAndTheFirstLooseJoint) {
  std::vector<std::string> kept{"t_s",       "guide_m",     "guide_m_s",    "guide_m_s2", "guide_force_x_n",
                                "wheel_rad", "wheel_rad_s", "wheel_rad_s2", "rod_rad",    "rod_rad_s"};
  const auto ideal = jobs::choose_section(kept, "", {});
  EXPECT_EQ(ideal.angle, "wheel_rad");
  EXPECT_THAT(ideal.wanted, ElementsAre("guide_m", "guide_m_s"));
  EXPECT_THAT(ideal.read, ElementsAre("guide_m", "guide_m_s", "wheel_rad", "guide_m_s2", "wheel_rad_s",
                                      "wheel_rad_s2"));
  EXPECT_EQ(jobs::choose_section(kept, "rod_rad", {}).angle, "rod_rad");
  kept.insert(kept.end(), {"pin_journal_x_mm", "pin_journal_y_mm", "end_journal_x_mm", "end_journal_y_mm"});
  EXPECT_THAT(jobs::choose_section(kept, "", {}).wanted, ElementsAre("pin_journal_x_mm", "pin_journal_y_mm"));
}

TEST(ChooseSection, RefusesWhatDoesNotTurn) {
  const std::vector<std::string> kept{"t_s", "guide_m", "guide_m_s", "wheel_rad", "wheel_rad_s"};
  EXPECT_THROW((void)jobs::choose_section(kept, "guide_m", {}), jobs::InvalidRequest);
  EXPECT_THROW((void)jobs::choose_section(kept, "crank_rad", {}), jobs::InvalidRequest);
  EXPECT_THROW((void)jobs::choose_section({"t_s", "guide_m", "guide_m_s"}, "", {"guide_m"}),
               jobs::WrongState);
  EXPECT_THROW((void)jobs::choose_section({"t_s", "wheel_rad", "wheel_rad_s"}, "", {}), jobs::WrongState);
}

/// An exponent's statistics over many sets of runs.
struct Sets {
  int count = 0, holding = 0, above = 0, below = 0;  ///< intervals that hold a value, lie above or below 0
  double sum = 0.0;

  void add(const jobs::Divergence& divergence, double value) {
    ++count;
    ASSERT_TRUE(divergence.exponent.has_value());
    const auto& [exponent, low, high] = *divergence.exponent;
    EXPECT_LE(divergence.from, divergence.to);
    holding += low <= value && value <= high ? 1 : 0;
    above += low > 0.0 ? 1 : 0;
    below += high < 0.0 ? 1 : 0;
    sum += exponent;
  }
};

std::vector<double> times_of(std::size_t samples, double dt) {
  std::vector<double> t;
  for (std::size_t k = 0; k < samples; ++k) t.push_back(static_cast<double>(k) * dt);
  return t;
}

/// One step of Runge and Kutta's method of order 4.
template <typename State, typename Rate>
void advance(State& u, double t, double h, const Rate& rate) {
  const auto moved = [&](const State& k, double by) {
    State at = u;
    for (std::size_t i = 0; i < u.size(); ++i) at[i] += by * k[i];
    return at;
  };
  const State k1 = rate(t, u), k2 = rate(t + h / 2, moved(k1, h / 2)), k3 = rate(t + h / 2, moved(k2, h / 2)),
              k4 = rate(t + h, moved(k3, h));
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
}

using Lorenz = std::array<double, 3>;

Lorenz lorenz_rate(double, const Lorenz& u) {
  return {10.0 * (u[1] - u[0]), u[0] * (28.0 - u[2]) - u[1], u[0] * u[1] - 8.0 / 3.0 * u[2]};
}

/// x and y, 100 samples a second.
jobs::Orbit lorenz_orbit(Lorenz u, std::size_t samples) {
  jobs::Orbit orbit(2);
  for (std::size_t k = 0; k < samples; ++k) {
    orbit[0].push_back(u[0]);
    orbit[1].push_back(u[1]);
    advance(u, 0.0, 0.005, lorenz_rate);
    advance(u, 0.0, 0.005, lorenz_rate);
  }
  return orbit;
}

// sigma = 10, rho = 28, beta = 8/3: 0.906 (J. C. Sprott, Chaos and Time-Series Analysis, 2003, appendix A).
TEST(Divergence, HasTheExponentOfLorenzsSystem) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Lorenz u{1.0, 1.0, 20.0};
  Sets sets;
  for (int set = 0; set < 40; ++set) {
    for (int k = 0; k < 2000; ++k) advance(u, 0.0, 0.01, lorenz_rate);
    constexpr std::size_t kSamples = 6000;
    jobs::DivergenceMeasurement measurement(times_of(kSamples, 0.01), lorenz_orbit(u, kSamples), 2.0);
    for (int pair = 0; pair < 4; ++pair) {
      Lorenz v = u;
      for (double& x : v) x += 1e-7 * normal(generator);
      measurement.add(lorenz_orbit(v, kSamples));
    }
    const jobs::Divergence divergence = measurement.finish();
    EXPECT_EQ(divergence.parted, 4U);
    EXPECT_GE(divergence.from, 2.0);
    sets.add(divergence, 0.906);
  }
  EXPECT_GE(sets.holding, 37) << "of 40, with 95 % confidence each";
  EXPECT_GE(sets.above, 24) << "chaos is seen in most sets";
  // A stretch ends with the first peak of the distance that reaches the ceiling, which makes the slope 6 %
  // low. One set scatters by 0.09, 40 by 0.014.
  EXPECT_NEAR(sets.sum / 40.0, 0.94 * 0.906, 0.042);
}

// ln d is a random walk without drift. Of most sets some pairs part and others do not; a mean over those that
// part, or a mean of the slopes, is biased.
TEST(Divergence, OfRandomWalksIsZero) {
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal;
  const auto t = times_of(5000, 1e-3);
  jobs::Orbit run(2);
  for (const double time : t) {
    run[0].push_back(std::sin(7.0 * time));
    run[1].push_back(std::cos(5.0 * time));
  }
  for (const double deviation : {0.5, 1.0, 2.0, 3.0}) {  // in a second
    for (const bool alike : {false, true}) {             // all pairs of a set, as in the linear regime
      Sets sets;
      std::size_t parted = 0;
      for (int set = 0; set < 200; ++set) {
        jobs::DivergenceMeasurement measurement(t, run, 1.0);
        std::vector<double> logarithms(t.size());
        for (int pair = 0; pair < 4; ++pair) {
          double w = std::log(1e-3);
          for (std::size_t k = 0; k < t.size() && (pair == 0 || !alike); ++k) {
            logarithms[k] = w;
            w += deviation * std::sqrt(1e-3) * normal(generator);
          }
          jobs::Orbit neighbour = run;
          for (std::size_t k = 0; k < t.size(); ++k)
            neighbour[0][k] += std::min(1.5, (1.0 + 0.2 * pair) * std::exp(logarithms[k]));
          measurement.add(neighbour);
        }
        const jobs::Divergence divergence = measurement.finish();
        parted += divergence.parted;
        if (divergence.exponent) sets.add(divergence, 0.0);
      }
      EXPECT_GE(sets.holding, 0.93 * sets.count) << deviation << ", alike: " << alike;
      EXPECT_GE(sets.count, 170);
      if (deviation == 2.0) {
        EXPECT_GT(parted, 100U);
      }
      // The mean of 200 sets of 4 pairs is known to deviation / sqrt(4 s * 4 * 200), or less.
      if (!alike) {
        EXPECT_NEAR(sets.sum / sets.count, 0.0, 4.0 * deviation / std::sqrt(3200.0)) << deviation;
      }
    }
  }
}

// Neighbours on a torus keep their distance, or grow apart in proportion to time where it has shear.
TEST(Divergence, OnATorusIsZero) {
  for (const double shear : {0.0, 1.0, 5.0}) {
    for (const double apart : {1e-8, 1e-5, 1e-3}) {
      Sets sets;
      for (int set = 0; set < 40; ++set) {
        const auto t = times_of(6000, 0.001 * (1 + set % 4));
        const auto orbit = [&](double offset) {
          jobs::Orbit made(2);
          for (const double time : t) {
            const double a = 0.37 * set + 6.0 * time + offset * (1.0 + shear * time);
            const double b = (std::sqrt(5.0) - 1.0) / 2.0 * 6.0 * time + 0.7 * offset;
            made[0].push_back((2.0 + std::cos(b)) * std::cos(a));
            made[1].push_back((2.0 + std::cos(b)) * std::sin(a));
          }
          return made;
        };
        jobs::DivergenceMeasurement measurement(t, orbit(0.0), 0.5 * (set % 3));
        for (int pair = 1; pair <= 4; ++pair) measurement.add(orbit(apart * pair));
        sets.add(measurement.finish(), 0.0);
      }
      EXPECT_EQ(sets.holding, 40) << shear << ", " << apart;
    }
  }
}

// q'' = -sin q - c q' with and without a drive: distances shrink as exp(-c t / 2).
TEST(Divergence, OfADampedPendulumIsNegative) {
  for (const double drive : {0.0, 0.4}) {
    for (const double apart : {1e-6, 1e-4, 1e-3}) {
      Sets sets;
      for (int set = 0; set < 20; ++set) {
        const auto orbit = [&](double q) {
          std::array<double, 2> u{q, 0.0};
          jobs::Orbit made(1);
          for (int k = 0; k < 3000; ++k) {
            made[0].push_back(u[0]);
            advance(u, 0.01 * k, 0.01, [&](double t, const std::array<double, 2>& at) {
              return std::array<double, 2>{at[1], -std::sin(at[0]) - 0.6 * at[1] + drive * std::sin(0.7 * t)};
            });
          }
          return made;
        };
        const double q = 0.3 + 0.05 * set;
        jobs::DivergenceMeasurement measurement(times_of(3000, 0.01), orbit(q), 0.0);
        for (int pair = 1; pair <= 4; ++pair) measurement.add(orbit(q + apart * pair));
        sets.add(measurement.finish(), -0.3);
      }
      EXPECT_EQ(sets.above, 0) << drive << ", " << apart;
      EXPECT_LT(sets.sum / 20.0, -0.2) << drive << ", " << apart;
      if (apart == 1e-3) {
        EXPECT_EQ(sets.holding, 20) << drive;
      }
    }
  }
}

TEST(Divergence, IsExactWhereTheDistanceGrowsByAFactor) {
  const auto t = times_of(401, 0.01);
  jobs::Orbit a(1), b(1), ended(1);
  for (const double time : t) {
    a[0].push_back(std::sin(time));
    b[0].push_back(a[0].back() + 1e-7 * std::exp(3.0 * time));
  }
  ended[0].assign(a[0].begin(), a[0].begin() + 300);  // a run that failed at 3 s
  jobs::DivergenceMeasurement measurement(t, a, 1.0);
  measurement.add(b);
  const auto divergence = measurement.finish();
  EXPECT_NEAR(divergence.exponent->value, 3.0, 1e-6);
  EXPECT_NEAR(divergence.exponent->high - divergence.exponent->low,
              2.0 * std::log(divergence.to / divergence.from) / (divergence.to - divergence.from), 1e-6);
  EXPECT_GE(divergence.from, 1.0) << "it begins where it is told to";
  measurement.add(ended);
  EXPECT_NEAR(measurement.finish().exponent->value, 3.0, 1e-6) << "no distance at all";
}

TEST(Divergence, OfTheSameRunIsZero) {
  const auto t = times_of(401, 0.01);
  jobs::Orbit run(1);
  for (const double time : t) run[0].push_back(std::sin(time));
  jobs::DivergenceMeasurement measurement(t, run, 1.0);
  measurement.add(run);
  const auto divergence = measurement.finish();
  EXPECT_EQ(divergence.parted, 0U);
  EXPECT_EQ(divergence.exponent->value, 0.0);
  EXPECT_LT(divergence.exponent->low, 0.0);
  EXPECT_GT(divergence.exponent->high, 0.0);
}

TEST(Divergence, IsEmptyIfAllHadPartedBefore) {
  const auto t = times_of(401, 0.01);
  jobs::Orbit run(1), other(1);
  for (const double time : t) {
    run[0].push_back(std::sin(time));
    other[0].push_back(std::cos(time));
  }
  jobs::DivergenceMeasurement measurement(t, run, 1.0);
  measurement.add(other);
  EXPECT_EQ(measurement.finish().parted, 1U);
  EXPECT_FALSE(measurement.finish().exponent.has_value());
}

}  // namespace
}  // namespace jobs_tests
