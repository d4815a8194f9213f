// SPDX-License-Identifier: Apache-2.0
// Properties of the linkage without clearance that the validation's chapter on kinematics leaves open.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "engine/analysis/ideal_peak.h"
#include "engine/model/drive_law.h"
#include "engine/model/rpsup.h"
#include "engine/model/rpsup_geometry.h"
#include "engine/simulate.h"
#include "engine/simulate_rpsup.h"
#include "validation/reference/ideal_linkage.h"
#include "validation/support/runs.h"

namespace engine {
namespace {

using validation::calc_slider;
using validation::column;
using validation::metric;

constexpr double kNever = std::numeric_limits<double>::infinity();

double closed_form(const RpsupParameters& p, double t) { return std::abs(calc_slider(p, t).derivative(2)); }

/// Largest |acceleration| of the closed form in [from, to]: a dense scan, and ever denser ones about each of its maxima that contends.
double scan_peak(const RpsupParameters& p, double from, double to, double interval) {
  const auto samples = static_cast<int>(std::ceil((to - from) / interval));
  std::vector<double> a;
  for (int k = 0; k <= samples; ++k) a.push_back(closed_form(p, from + (to - from) * k / samples));
  double peak = *std::max_element(a.begin(), a.end());
  for (double corner = find_next_corner(rod_law(p), from); corner < to; corner = find_next_corner(rod_law(p), corner))  // both sides of a jump
    peak = std::max({peak, closed_form(p, corner * (1.0 - 1e-13)), closed_form(p, corner * (1.0 + 1e-13))});
  for (std::size_t k = 0; k < a.size(); ++k) {
    const bool is_maximum = (k == 0 || a[k] >= a[k - 1]) && (k + 1 == a.size() || a[k] >= a[k + 1]);
    if (!is_maximum || a[k] < 0.99 * peak) continue;
    double middle = from + (to - from) * static_cast<double>(k) / samples;
    for (double reach = (to - from) / samples; reach > 1e-6 * interval; reach *= 0.1) {
      double best = middle;
      for (int i = -20; i <= 20; ++i) {
        const double t = std::clamp(middle + reach * i / 20.0, from, to);
        if (closed_form(p, t) > closed_form(p, best)) best = t;
      }
      middle = best;
    }
    peak = std::max(peak, closed_form(p, middle));
  }
  return peak;
}

class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  double between(double least, double most) { return least + (most - least) * std::ldexp(static_cast<double>(bits_()), -32); }
  double by_magnitude(double least, double most) { return std::exp(between(std::log(least), std::log(most))); }
  bool one_of(int n) { return between(0.0, 1.0) * n < 1.0; }

 private:
  std::mt19937 bits_;
};

/// A linkage of any speed, whose coupler is longer than the farthest place it must reach by `spare` of that, squared.
RpsupParameters draw_linkage(Random& random, double spare, double& duration) {
  RpsupParameters p;
  p.c_r = 0.0;
  const double speed = random.by_magnitude(0.1, 500.0);
  p.crank_velocity = random.one_of(2) ? speed : -speed;
  p.run_up = random.one_of(4) ? 0.0 : random.by_magnitude(0.1, 20.0) / speed;
  p.rod_stroke = random.one_of(8) ? 0.0 : random.between(-0.1, 0.2);
  p.rod_stroke_time = random.by_magnitude(0.3, 30.0) / speed;
  p.rod_pause = random.one_of(3) ? 0.0 : random.by_magnitude(0.1, 30.0) / speed;
  p.rod_start = random.between(0.1, 0.25);
  p.rod_law = random.one_of(2) ? StrokeLaw::kCycloidal : random.one_of(2) ? StrokeLaw::kCosine : StrokeLaw::kParabolic;
  p.crank_start = random.one_of(2) ? 0.0 : random.between(-3.0, 3.0);
  p.yoke_axis = random.one_of(2) ? YokeAxis::kGuide : YokeAxis::kAcross;
  p.guide_offset_y = random.one_of(3) ? 0.0 : random.between(-0.2, 0.2);
  p.guide_offset_z = random.one_of(3) ? 0.0 : random.between(-0.3, 0.3);  // 0: flat, where the determinant vanishes as a square
  if (p.yoke_axis == YokeAxis::kGuide) p.guide_offset_z = std::copysign(0.1 + std::abs(p.guide_offset_z), p.guide_offset_z);  // never met
  p.guide_angle = random.one_of(2) ? 0.0 : random.between(-0.15, 0.15);
  duration = p.run_up + random.by_magnitude(0.1, 20.0) / speed;
  p.coupler_length = 0.0;
  double farthest = 0.0;
  for (int k = 0; k <= 100000; ++k) farthest = std::max(farthest, -calc_coupler_projection_squared(p, duration * k / 100000.0));
  p.coupler_length = std::sqrt(farthest * (1.0 + spare * spare));
  p.links[static_cast<std::size_t>(Link::k13)] = beam_inertia(0.306, p.coupler_length, 3.829e-6);
  return p;
}

TEST(DriveLaw, HasItsCornersWhereItsPiecesMeet) {
  const DriveLaw rise = RiseReturnPause{.stroke = 0.05, .stroke_time = 0.3, .pause = 0.25};
  double t = 0.0;
  for (const double corner : {0.3, 0.6, 0.85, 1.15, 1.45, 1.7, 2.0}) {
    t = find_next_corner(rise, t);
    EXPECT_NEAR(t, corner, 1e-14);
  }
  EXPECT_EQ(find_next_corner(RiseReturnPause{.stroke = 0.0, .stroke_time = 0.3, .pause = 0.25}, 0.1), kNever);
  const DriveLaw run_up = RunUp{.omega = -3.0, .run_up = 1.7};
  EXPECT_EQ(find_next_corner(run_up, 0.4), 1.7);
  EXPECT_EQ(find_next_corner(run_up, 1.7), kNever);
}

TEST(DriveLaw, MovesByAboutARadianInItsTimeScale) {
  const RunUp run_up{.omega = -300.0, .run_up = 1.7};
  EXPECT_EQ(calc_time_scale(run_up, 2.0), 1.0 / 300.0);
  for (double t = 0.0; t < 1.8; t += 0.013) {
    const double scale = calc_time_scale(run_up, t);
    EXPECT_GT(scale, 0.0);
    for (const double part : {0.0, 0.05, 0.1}) EXPECT_LE(std::abs(calc_driven_motion(run_up, t + part * scale).qd) * scale, 1.0 + 1e-12) << t;
  }
  const RiseReturnPause rise{.stroke = 0.05, .stroke_time = 0.3, .pause = 0.25};
  EXPECT_LT(calc_time_scale(rise, 0.4), 0.1);
  EXPECT_EQ(calc_time_scale(rise, 0.7), kNever);
  EXPECT_EQ(calc_time_scale(RunUp{}, 0.7), kNever);
}

// The closed form is sampled each 0.002 rad of either drive, or 0.1 ms: what lies between is found by sampling anew.
TEST(IdealPeak, MissesNoExtremeOfAnyLinkage) {
  Random random(20);
  for (int i = 0; i < 60; ++i) {
    double duration = 0.0;
    const double spare = random.by_magnitude(0.01, 1.0);
    const RpsupParameters p = draw_linkage(random, spare, duration);
    const double interval = std::min({1e-4, 2e-3 / std::abs(p.crank_velocity), 1e-3 * p.rod_stroke_time, 1e-3 * (duration - p.run_up)});
    if ((duration - p.run_up) / interval > 1e5) continue;
    const double peak = scan_peak(p, p.run_up, duration, interval);
    const std::optional<Peak> found = find_ideal_peak(p, p.run_up, duration, {});
    ASSERT_TRUE(found) << "case " << i;
    // Positions are right to 1e-13 m, the root of what the coupler reaches beyond is less so by the square of 1 / spare.
    const double tolerance = std::max(1e-9, 1e-11 / (spare * spare));
    EXPECT_NEAR(found->magnitude / peak, 1.0, tolerance) << "case " << i << " at " << found->t << " of " << duration << ", spare " << spare;
    EXPECT_NEAR(closed_form(p, found->t) / found->magnitude, 1.0, tolerance) << "case " << i;
  }
}

// The window ends where the rod's pause does: the rise that begins there, with a jump of the acceleration, is outside of it.
TEST(IdealPeak, EndsBeforeAJumpAtTheEndOfItsWindow) {
  RpsupParameters p;
  p.c_r = 0.0;
  p.rod_law = StrokeLaw::kCosine;
  p.crank_velocity = 0.1;
  p.run_up = 2.0 * p.rod_stroke_time + 0.1 * p.rod_pause;
  const double end = 2.0 * p.rod_stroke_time + p.rod_pause;
  const RunResult run = run_rpsup(p, {.duration = end, .output_rate = 1000.0});
  EXPECT_NEAR(metric(run, "amplification"), 1.0, 1e-6);
}

TEST(IdealPeak, StandsTheEdgesOfItsWindow) {
  const RpsupParameters p;
  EXPECT_FALSE(find_ideal_peak(p, 2.0, 2.0, {}));
  for (const double length : {4e-16, 1e-12, 1e-6}) {
    const double to = 2.0 + length;
    const std::optional<Peak> found = find_ideal_peak(p, 2.0, to, {});
    ASSERT_TRUE(found) << length;
    EXPECT_NEAR(found->magnitude, std::max(closed_form(p, 2.0), closed_form(p, to)), 1e-9) << length;
  }
  EXPECT_FALSE(find_ideal_peak(p, 2.0, 400.0, [](double) { return true; }));
}

// Strokes that end between all instants of any grid, sampled coarser than the drives move and finer.
TEST(IdealLinkage, HasThePeaksOfTheClosedForm) {
  for (const double rate : {7.0, 1000.0, 1300.0}) {
    RpsupParameters p;
    p.c_r = 0.0;
    p.run_up = 0.41234567;
    p.rod_stroke_time = 0.3217891;
    p.rod_pause = 0.1234543;
    constexpr double kDuration = 1.98765;
    const RunResult run = simulate_rpsup(p, {.duration = kDuration, .output_rate = rate}, {});
    ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
    const double peak = scan_peak(p, p.run_up, kDuration, 1e-4);
    EXPECT_NEAR(metric(run, "peak_slider_acceleration_m_s2") / peak, 1.0, 1e-9) << rate;
    EXPECT_NEAR(closed_form(p, metric(run, "peak_slider_acceleration_time_s")) / peak, 1.0, 1e-9) << rate;
    EXPECT_LT(metric(run, "energy_residual"), 1e-10) << rate;
    double torque = 0.0;
    double rod_force = 0.0;
    double reaction = 0.0;
    for (int k = 0; k <= 20000; ++k) {
      const validation::IdealForces forces = validation::calc_ideal_forces(p, kDuration * k / 20000.0);
      torque = std::max(torque, std::abs(forces.crank_torque));
      rod_force = std::max(rod_force, std::abs(forces.rod_force));
      reaction = std::max(reaction, forces.reaction_W.norm());
    }
    // Samples 0.1 ms apart miss (20 rad/s x 0.05 ms)^2 / 2 of a turning point, and the slope of 1 % a millisecond times 0.05 ms at a kink.
    EXPECT_NEAR(metric(run, "peak_crank_torque_n_m") / torque, 1.0, 1e-6) << rate;
    EXPECT_NEAR(metric(run, "peak_rod_force_n") / rod_force, 1.0, 1e-6) << rate;
    EXPECT_NEAR(metric(run, "peak_joint_reaction_n") / reaction, 1.0, 1e-6) << rate;
  }
}

// Duration and corners one rounding beside the grid of the steps make no steps of no length.
TEST(IdealLinkage, TakesDurationsBesideTheGrid) {
  RpsupParameters p;
  p.c_r = 0.0;
  p.run_up = 0.1;
  p.rod_stroke_time = 0.1;
  p.rod_pause = 0.0;
  for (const double duration : {0.1 * 3.0, std::nextafter(0.3, 0.0), 0.3, std::nextafter(0.2, 1.0), 1e-9}) {
    const RunResult run = simulate_rpsup(p, {.duration = duration}, {});
    ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
    EXPECT_EQ(run.t_end, duration);
    EXPECT_EQ(column(run, "t_s").back(), duration);
    if (duration < p.run_up) continue;
    EXPECT_NEAR(metric(run, "peak_slider_acceleration_m_s2") / scan_peak(p, p.run_up, duration, 1e-4), 1.0, 1e-8);
    EXPECT_TRUE(std::isfinite(metric(run, "rms_slider_acceleration_m_s2")));
  }
}

// The coupler comes upright but for a hair each half turn, and there the other way to close the loop is near.
TEST(IdealLinkage, KeepsToItsBranchNearLockUp) {
  Random random(3);
  for (int i = 0; i < 25; ++i) {
    double duration = 0.0;
    const RpsupParameters p = draw_linkage(random, 2e-3, duration);
    const RunResult run = simulate_rpsup(p, {.duration = duration, .output_rate = 200.0 / duration}, {});
    ASSERT_EQ(run.status, RunStatus::kSucceeded) << "case " << i << ": " << run.detail;
    const std::vector<double>& t = column(run, "t_s");
    const std::vector<double>& z = column(run, "slider_position_m");
    ASSERT_GE(t.size(), 200U);
    for (std::size_t k = 0; k < t.size(); ++k) ASSERT_NEAR(z[k], calc_slider(p, t[k]).derivative(0), 1e-10) << "case " << i << " at " << t[k];
  }
}

// Samples fall between the instants of the solution too, and energy and work must be of one instant.
TEST(IdealLinkage, EnergyAndWorkOfASampleBelongTogether) {
  RpsupParameters parameters;
  parameters.c_r = 0.0;
  const RunResult run = simulate_rpsup(parameters, {.duration = 2.3, .output_rate = 1300.0}, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  double worst = 0.0;
  for (const double residual : column(run, "energy_residual")) worst = std::max(worst, std::abs(residual));
  EXPECT_LT(worst, 1e-10);  // quartics through five instants, of the power
}

class NoObserver : public Observer {
 public:
  void on_step(const Evaluation&, const Evaluation&) override {}
  void on_sample(const Evaluation&) override {}
  void on_onsets(int, int) override {}
  bool stop_requested(double) override { return false; }
};

// r sin(psi) reaches what the coupler can at psi = asin(sqrt(l^2 - z_g^2) / r), and psi = omega t.
TEST(IdealLinkage, EndsWhereItLocks) {
  RpsupParameters p;
  p.c_r = 0.0;
  p.run_up = 0.0;
  p.rod_stroke = 0.0;
  p.coupler_length = 0.25;
  const double locked = std::asin(std::sqrt(0.25 * 0.25 - 0.24 * 0.24) / p.rod_start) / p.crank_velocity;
  NoObserver observer;
  const RunOutcome end = simulate(build_rpsup(p).mechanism, {.duration = 1.0}, observer);
  EXPECT_EQ(end.status, RunStatus::kLockUp);
  EXPECT_NEAR(end.t, locked, 1e-6);
  EXPECT_LE(end.t, locked);
  EXPECT_LT(end.evaluations, 10000);
  EXPECT_FALSE(find_ideal_peak(p, 0.0, 1.0, {}));
}

// From some 2000 rad on an angle is rounded by more than the loops of small angles close to.
TEST(IdealLinkage, TurnsAsOftenAsItIsDriven) {
  RpsupParameters parameters;
  parameters.c_r = 0.0;
  parameters.crank_velocity = 1000.0;
  parameters.run_up = 0.1;
  const RunResult fast = simulate_rpsup(parameters, {.duration = 2.8, .output_rate = 100.0}, {});
  ASSERT_EQ(fast.status, RunStatus::kSucceeded) << fast.detail;
  const double t = column(fast, "t_s").back(), peak = metric(fast, "peak_slider_acceleration_m_s2");
  EXPECT_NEAR(column(fast, "slider_acceleration_m_s2").back(), calc_slider(parameters, t).derivative(2), 1e-8 * peak);
}

}  // namespace
}  // namespace engine
