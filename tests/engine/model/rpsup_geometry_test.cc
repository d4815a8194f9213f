// SPDX-License-Identifier: Apache-2.0
// The linkage's geometry and the laws of its rod against formulas written out here.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "engine/errors.h"
#include "engine/model/drive_piece.h"
#include "engine/model/rpsup.h"
#include "engine/simulate_rpsup.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/runs.h"

namespace engine {
namespace {

using validation::across_rpsup;
using validation::column;
using validation::metric;
using validation::run_rpsup;

struct Geometry {
  const char* name;
  YokeAxis yoke;
  double y, z, angle_deg, start;
  StrokeLaw law;
};
void PrintTo(const Geometry& g, std::ostream* out) { *out << g.name; }

RpsupParameters make_parameters(const Geometry& g) {
  RpsupParameters p;
  p.c_r = 0.0;
  p.run_up = 0.5;
  p.yoke_axis = g.yoke;
  p.guide_offset_y = g.y;
  p.guide_offset_z = g.z;
  p.guide_angle = g.angle_deg * std::numbers::pi / 180.0;
  p.crank_start = g.start;
  p.rod_law = g.law;
  return p;
}

/// C(u) = u - sin(2 std::numbers::pi u) / (2 std::numbers::pi)
double cycloid(double u) { return u - std::sin(2.0 * std::numbers::pi * u) / (2.0 * std::numbers::pi); }

double part_of_stroke(StrokeLaw law, double u) {
  if (law == StrokeLaw::kCycloidal) return cycloid(u);
  if (law == StrokeLaw::kCosine) return 0.5 * (1.0 - std::cos(std::numbers::pi * u));
  return u < 0.5 ? 2.0 * u * u : 1.0 - 2.0 * (1.0 - u) * (1.0 - u);
}

/// Integral of omega_0 C(t / run_up), then a straight line.
double crank_angle(const RpsupParameters& p, double t) {
  if (t >= p.run_up) return p.crank_start + p.crank_velocity * (t - 0.5 * p.run_up);
  const double u = t / p.run_up, two_pi = 2.0 * std::numbers::pi;
  return p.crank_start +
         p.crank_velocity * p.run_up * (0.5 * u * u + (std::cos(two_pi * u) - 1.0) / (two_pi * two_pi));
}

double s_joint_radius(const RpsupParameters& p, double t) {
  const double in_cycle = std::fmod(t, 2.0 * p.rod_stroke_time + p.rod_pause) / p.rod_stroke_time;
  const double part = in_cycle < 1.0   ? part_of_stroke(p.rod_law, in_cycle)
                      : in_cycle < 2.0 ? 1.0 - part_of_stroke(p.rod_law, in_cycle - 1.0)
                                       : 0.0;
  return p.rod_start + p.rod_stroke * part;
}

/// The slider at the coupler's length from the S joint: s^2 - 2 s (d . w) + |w|^2 = l^2 with w from the
/// guide's origin to the S joint.
double slider_position(const RpsupParameters& p, double t) {
  const double r = s_joint_radius(p, t), psi = crank_angle(p, t);
  const Eigen::Vector3d w(r * std::cos(psi), r * std::sin(psi) - p.guide_offset_y, -p.guide_offset_z);
  const Eigen::Vector3d d(std::cos(p.guide_angle), 0.0, std::sin(p.guide_angle));
  const double dw = d.dot(w);
  return dw + std::sqrt(dw * dw - w.squaredNorm() + p.coupler_length * p.coupler_length);
}

class IdealGeometry : public testing::TestWithParam<Geometry> {};

TEST_P(IdealGeometry, MovesTheSliderAsTheTriangleDoes) {
  const RpsupParameters p = make_parameters(GetParam());
  const RunResult run = run_rpsup(p, {.duration = 1.7, .output_rate = 500.0});
  const std::vector<double>& t = column(run, "t_s");
  ASSERT_EQ(t.size(), 851u);
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(column(run, "slider_position_m")[k], slider_position(p, t[k]), 1e-12) << t[k];
    // Central differences of fourth order: error h^4 z'''''  / 30 is below 1e-7 away from the corners, where
    // they do not apply.
    constexpr double h = 1e-4;
    const double in_half_stroke = std::fmod(t[k], 0.25);
    if (t[k] < 0.01 || in_half_stroke < 3.0 * h || in_half_stroke > 0.25 - 3.0 * h) continue;
    const double velocity = (8.0 * (slider_position(p, t[k] + h) - slider_position(p, t[k] - h)) -
                             (slider_position(p, t[k] + 2.0 * h) - slider_position(p, t[k] - 2.0 * h))) /
                            (12.0 * h);
    EXPECT_NEAR(column(run, "slider_velocity_m_s")[k], velocity, 1e-9) << t[k];
  }
}

/// Poses: x of the coupler points from the S joint to the slider; the axis of joint R is at right angles
/// to it and to the yoke.
TEST_P(IdealGeometry, KeepsTheAxisOfJointRAcrossCouplerAndYoke) {
  const RpsupParameters p = make_parameters(GetParam());
  const RunResult run = run_rpsup(p, {.duration = 1.0, .output_rate = 100.0});
  const auto axis = [&run](const std::string& link, const Eigen::Vector3d& of_link,
                           std::size_t k) -> Eigen::Vector3d {
    std::array<double, 4> q{};
    for (std::size_t i = 0; i < 4; ++i) q[i] = column(run, "pose_" + link + "_q" + "wxyz"[i])[k];
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * of_link;
  };
  const Eigen::Vector3d yoke_in_slider =
      p.yoke_axis == YokeAxis::kGuide ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d guide(std::cos(p.guide_angle), 0.0, std::sin(p.guide_angle));
  constexpr double kKept = 1e-6;  // channels keep 24 bits of each value
  for (std::size_t k = 0; k < column(run, "t_s").size(); ++k) {
    const Eigen::Vector3d z_22 = axis("2_2", Eigen::Vector3d::UnitZ(), k);
    EXPECT_NEAR(std::abs(z_22.dot(axis("1_3", Eigen::Vector3d::UnitZ(), k))), 1.0, kKept);
    EXPECT_NEAR(z_22.dot(axis("1_3", Eigen::Vector3d::UnitX(), k)), 0.0, kKept);
    EXPECT_NEAR(z_22.dot(axis("2_1", yoke_in_slider, k)), 0.0, kKept);
    EXPECT_NEAR((axis("2_1", Eigen::Vector3d::UnitX(), k) - guide).norm(), 0.0, kKept);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Engine, IdealGeometry,
    testing::Values(
        Geometry{"yoke_about_the_guide", YokeAxis::kGuide, 0.0, 0.24, 0.0, 0.0, StrokeLaw::kCosine},
        Geometry{"guide_below", YokeAxis::kGuide, 0.0, -0.24, 0.0, 0.0, StrokeLaw::kCycloidal},
        Geometry{"guide_beside", YokeAxis::kGuide, 0.3, 0.1, 0.0, 1.2, StrokeLaw::kParabolic},
        Geometry{"guide_turned", YokeAxis::kGuide, 0.05, 0.24, 25.0, -0.7, StrokeLaw::kCosine},
        Geometry{"guide_along_the_cranks_axis", YokeAxis::kGuide, 0.3, 0.1, 90.0, 0.4, StrokeLaw::kCycloidal},
        Geometry{"yoke_across", YokeAxis::kAcross, 0.0, 0.2, 0.0, 0.0, StrokeLaw::kCycloidal},
        Geometry{"yoke_across_a_turned_guide", YokeAxis::kAcross, 0.05, 0.2, -30.0, 2.0,
                 StrokeLaw::kParabolic}),
    [](const auto& c) { return c.param.name; });

// A cross link of length a reaches from the slider to joint R along z_22, at right angles to the guide and to
// the coupler.
TEST(CrossLinkAboutTheGuide, ReachesTheCouplersEnd) {
  RpsupParameters p;
  p.c_r = 0.0;
  p.run_up = 0.5;
  p.cross_length = 0.1;
  p.links[4] = {0.107, {9.354e-5 + 0.107 * 0.0025, 9.354e-5 + 0.107 * 0.0025, 8.377e-6}};
  const RunResult run = run_rpsup(p, {.duration = 1.0, .output_rate = 100.0});
  for (std::size_t k = 0; k < column(run, "t_s").size(); ++k) {
    const double t = column(run, "t_s")[k], r = s_joint_radius(p, t), psi = crank_angle(p, t);
    // The coupler's end is a beside the guide in the plane through z_22: along the guide the coupler has left
    // l^2 - rho^2 + a^2.
    const double rho2 = std::pow(r * std::sin(psi), 2) + p.guide_offset_z * p.guide_offset_z;
    const double expected = r * std::cos(psi) + std::sqrt(0.25 - rho2 + 0.01);
    EXPECT_NEAR(column(run, "slider_position_m")[k], expected, 1e-12) << t;
  }
}

/// With a crank that does not turn the slider goes with the rod: z = rod + sqrt(l^2 - z_g^2).
double largest_acceleration_of_the_rod(StrokeLaw law, double clearance, Integrator integrator) {
  RpsupParameters p;
  p.crank_velocity = 0.0;
  p.run_up = 0.2;
  p.rod_law = law;
  p.c_r = clearance;
  return metric(run_rpsup(p, {.duration = 1.4, .integrator = integrator}), "peak_slider_acceleration_m_s2");
}

TEST(StrokeLaws, GiveTheIdealSliderTheirLargestAcceleration) {
  constexpr double kStroke = 0.015, kTime = 0.5, kOver = kStroke / (kTime * kTime);
  EXPECT_NEAR(largest_acceleration_of_the_rod(StrokeLaw::kCycloidal, 0.0, Integrator::kAuto),
              2.0 * std::numbers::pi * kOver, 1e-9);
  // At the ends of a stroke, where the acceleration jumps: steps see both sides.
  EXPECT_NEAR(largest_acceleration_of_the_rod(StrokeLaw::kCosine, 0.0, Integrator::kAuto),
              0.5 * std::numbers::pi * std::numbers::pi * kOver, 1e-9);
  EXPECT_NEAR(largest_acceleration_of_the_rod(StrokeLaw::kParabolic, 0.0, Integrator::kAuto), 4.0 * kOver,
              1e-9);
}

/// Steps end where the drive's acceleration jumps: one across a jump would take the wrong acceleration for a
/// part of it.
TEST(StrokeLaws, LetNoStepCrossAJump) {
  for (const StrokeLaw law : {StrokeLaw::kCosine, StrokeLaw::kParabolic})
    for (const double clearance : {0.0, 0.25e-3})
      for (const Integrator integrator : {Integrator::kRadau5, Integrator::kRodas5, Integrator::kDopri5}) {
        RpsupParameters p = across_rpsup();
        p.rod_law = law;
        p.run_up = 0.2;
        p.c_r = clearance;
        // Impacts make the coupler vibrate, and an explicit method follows every vibration, both for long.
        p.coupler =
            clearance > 0.0 || integrator == Integrator::kDopri5 ? Coupler::kRigid : Coupler::kFlexible;
        p.friction = FrictionLaw::kNone;
        const RunResult run = run_rpsup(p, {.duration = 0.8,
                                            .integrator = integrator,
                                            .relative_tolerance = 1e-8,
                                            .absolute_tolerance = 1e-9});
        // A step of 0.1 ms across a jump of 0.5 m/s^2 moves 1 kg at 0.1 m/s by 5e-6 J of some 5 J.
        EXPECT_LT(metric(run, "energy_residual"), 2e-8)
            << static_cast<int>(law) << ' ' << clearance << ' ' << static_cast<int>(integrator);
      }
}

// Jumps at whole steps: the last stage of a step that ends there takes the acceleration before the jump, and the order stays 4.
TEST(StrokeLaws, LetFixedStepsEndOnAJump) {
  std::array<double, 2> worst{};
  for (const std::size_t i : {0u, 1u}) {
    RpsupParameters p;
    p.c_r = 0.0;
    p.run_up = 0.2;
    p.drive = DriveEnforcement::kPrescribed;
    const RunResult run =
        run_rpsup(p, {.duration = 1.7, .output_rate = 100.0, .integrator = Integrator::kRk4, .step = i == 0 ? 1e-3 : 5e-4});
    for (std::size_t k = 0; k < column(run, "t_s").size(); ++k)
      worst[i] = std::max(worst[i], std::abs(column(run, "slider_position_m")[k] - slider_position(p, column(run, "t_s")[k])));
  }
  EXPECT_GT(worst[0], 1e-11);               // above rounding: there is an order to see
  EXPECT_GT(worst[0] / worst[1], 11.0);     // 16 in the limit; 2 if the last stage took the other side
}

// Jumps a rounding beside the grid of the steps, and beside the run-up's end, from which the ideal peak is sought.
TEST(StrokeLaws, JumpAtInstantsBesideTheGrid) {
  for (const StrokeLaw law : {StrokeLaw::kCosine, StrokeLaw::kParabolic})
    for (const double stroke_time : {0.1, 0.14, 0.3, 0.7})
      for (const double pause : {0.1, 0.34, 0.5})
        for (const double run_up : {0.2, 1.5, 2.0}) {
          RpsupParameters p;
          p.c_r = 0.0;
          p.rod_law = law;
          p.rod_stroke_time = stroke_time;
          p.rod_pause = pause;
          p.run_up = run_up;
          const RunResult run = run_rpsup(p, {.duration = 2.2, .output_rate = 10.0});
          EXPECT_LT(metric(run, "energy_residual"), 1e-10) << stroke_time << ' ' << pause << ' ' << run_up;
          EXPECT_NEAR(metric(run, "amplification"), 1.0, 1e-6) << stroke_time << ' ' << pause << ' ' << run_up;
        }
}

TEST(DrivePiece, EndsAtEachJump) {
  const std::vector<Drive> drives{
      {0, RunUp{3.0, 1.0}},
      {1, RiseReturnPause{.stroke = 0.01, .stroke_time = 0.4, .pause = 0.3, .law = StrokeLaw::kParabolic}}};
  DrivePiece piece(drives);
  for (const double end : {0.2, 0.4, 0.6, 0.8, 1.1, 1.3}) {
    EXPECT_NEAR(piece.end(), end, 1e-14);
    EXPECT_LT(piece.clamp(piece.end()), piece.end());
    const double before = piece.end();
    EXPECT_TRUE(piece.is_over(std::nextafter(before, 0.0)) && piece.is_over(before) && !piece.is_over(before - 1e-9));
    piece.advance();
    EXPECT_GT(piece.clamp(before), before);
  }
}

TEST(DrivePiece, IsAllOfTimeWhereNothingJumps) {
  const std::vector<Drive> drives{{0, RunUp{3.0, 1.0}},
                                  {1, RiseReturnPause{.stroke = 0.01, .stroke_time = 0.4, .pause = 0.3}}};
  const DrivePiece piece(drives);
  for (const double t : {0.0, 0.4, 0.8, 1e6}) EXPECT_EQ(piece.clamp(t), t);
  EXPECT_TRUE(std::isinf(piece.end()));
}

TEST(YokeAboutTheGuide, IsRefusedWhereTheSJointMeetsTheGuide) {
  RpsupParameters p;
  p.guide_offset_z = 0.0;  // the guide goes through the crank's centre: met at the start
  EXPECT_THROW(check_parameters(p, {}), InvalidInput);
  p.crank_start = 1.0;  // met on the way, between two looks
  p.guide_offset_y = 0.05;
  try {
    check_parameters(p, {});
    FAIL();
  } catch (const InvalidInput& fault) {
    EXPECT_EQ(fault.field(), "yoke");
    EXPECT_NE(fault.detail().find("locks at t = "), std::string::npos) << fault.detail();
  }
  p.guide_offset_y = 0.2;  // beyond the rod's end: never met
  EXPECT_NO_THROW(check_parameters(p, {}));
  p.guide_offset_y = 0.0;
  p.yoke_axis = YokeAxis::kAcross;
  p.crank_start = 0.0;
  EXPECT_NO_THROW(check_parameters(p, {}));
}

}  // namespace
}  // namespace engine
