// SPDX-License-Identifier: Apache-2.0
// Crank, rod and cross link as flexible links: that all methods and drives cope with them. Beam theory is part of the validation.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/model/rpsup.h"
#include "engine/simulate_rpsup.h"
#include "validation/flexibility/links.h"
#include "validation/support/runs.h"

namespace validation {
void PrintTo(const FlexibleLink& link, std::ostream* out);
void PrintTo(const FlexibleLink& link, std::ostream* out) { *out << link.name; }
}  // namespace validation

namespace engine {

namespace {

using validation::column;
using validation::metric;
using validation::run_rpsup;
using validation::with_cross;

RpsupParameters all_flexible() {
  RpsupParameters p = with_cross(0.1);
  p.coupler = p.crank.model = p.rod.model = p.cross.model = LinkModel::kFlexible;
  p.run_up = 0.1;
  return p;
}

class FlexibleLinks : public testing::TestWithParam<validation::FlexibleLink> {};

TEST_P(FlexibleLinks, DoWithFewElementsAsTheCouplerDoes) {
  RpsupParameters p = validation::with_flexible(GetParam(), 3);
  p.run_up = 0.1;
  const RunResult run = run_rpsup(p, {.duration = 0.3});
  EXPECT_LT(metric(run, "energy_residual"), 1e-6);
  EXPECT_GT(metric(run, "structural_loss_j"), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Engine, FlexibleLinks, testing::ValuesIn(validation::kFlexibleLinks),
                         [](const auto& c) { return std::string(c.param.name); });

// z = r cos psi + sqrt(l^2 - h^2 - z_g^2 + a^2), h the ball's height: the cross link's end goes round the guide at its length a.
TEST(CrossLink, OfALengthMovesTheSliderByItsClosedForm) {
  RpsupParameters p = with_cross(0.12);
  p.yoke_axis = YokeAxis::kAcross;
  p.c_r = 0.0;
  p.run_up = 0.1;
  p.guide_offset_y = 0.03;
  const RunResult run = run_rpsup(p, {.duration = 1.0, .output_rate = 50.0});
  for (std::size_t k = 0; k < column(run, "t_s").size(); ++k) {
    const double psi = column(run, "crank_angle_rad")[k];
    const double r = 0.2 + column(run, "rod_displacement_m")[k];
    const double height = r * std::sin(psi) - 0.03;
    EXPECT_NEAR(column(run, "slider_position_m")[k], r * std::cos(psi) + std::sqrt(0.25 - height * height - 0.0576 + 0.0144), 1e-9) << k;
  }
}

TEST(AllFlexible, DrivenByMultipliersTheyMoveAsDrivenByLaw) {
  RpsupParameters p = all_flexible();
  p.c_r = 0.0;
  const RunOptions options{.duration = 0.4, .output_rate = 100.0};
  const RunResult law = run_rpsup(p, options);
  p.drive = DriveEnforcement::kBaumgarte;
  const RunResult multipliers = run_rpsup(p, options);
  for (const char* key : {"slider_position_m", "crank_deflection_mm", "rod_deflection_mm", "cross_deflection_mm"}) {
    const std::vector<double>& a = column(law, key);
    const double largest = std::abs(*std::max_element(a.begin(), a.end()));
    ASSERT_GT(largest, 0.0);
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(column(multipliers, key)[k], a[k], 2e-2 * largest) << key << " at " << k;
  }
  EXPECT_LT(metric(law, "energy_residual"), 1e-6);
  EXPECT_LT(metric(multipliers, "energy_residual"), 1e-6);
  EXPECT_NEAR(metric(law, "peak_crank_torque_n_m"), metric(multipliers, "peak_crank_torque_n_m"), 0.02 * metric(law, "peak_crank_torque_n_m"));
}

// Steel halved is bent twice as far: all deflections at once, by the same loads.
TEST(AllFlexible, BendTwiceAsFarOfHalfTheModulus) {
  RpsupParameters p = all_flexible();
  p.c_r = 0.0;
  p.crank_velocity = 0.0;
  p.rod_stroke = 0.0;
  p.coupler_damping_ratio = p.crank.damping_ratio = p.rod.damping_ratio = p.cross.damping_ratio = 1.0;
  const RunOptions options{.duration = 0.3, .output_rate = 100.0};
  const RunResult steel = run_rpsup(p, options);
  p.youngs_modulus *= 0.5;
  p.shear_modulus *= 0.5;
  const RunResult half = run_rpsup(p, options);
  for (const char* key : {"crank_deflection_mm", "rod_deflection_mm", "cross_deflection_mm", "coupler_deflection_mm"})
    EXPECT_NEAR(column(half, key).back() / column(steel, key).back(), 2.0, 0.01) << key;
}

TEST(AllFlexible, ImplicitAndExplicitMethodsLandOnTheSameImpacts) {
  const RpsupParameters p = all_flexible();
  RunOptions options{.duration = 0.03, .integrator = Integrator::kDopri5, .relative_tolerance = 1e-8, .absolute_tolerance = 1e-9};
  const RunResult dopri5 = run_rpsup(p, options);
  ASSERT_GT(metric(dopri5, "impact_count"), 5.0);
  EXPECT_LT(metric(dopri5, "energy_residual"), 1e-6);
  options = {.duration = 0.03, .relative_tolerance = 1e-7, .absolute_tolerance = 1e-7};
  for (const Integrator integrator : {Integrator::kRodas5, Integrator::kRk4}) {
    options.integrator = integrator;
    options.step = 5e-7;
    const RunResult run = run_rpsup(p, options);
    EXPECT_EQ(metric(run, "impact_count"), metric(dopri5, "impact_count"));
    const std::vector<double>& y = column(dopri5, "journal_y_mm");
    ASSERT_EQ(column(run, "journal_y_mm").size(), y.size());
    for (std::size_t k = 0; k < y.size(); ++k) EXPECT_NEAR(column(run, "journal_y_mm")[k], y[k], 1e-3) << k;  // of +-0.25 mm
  }
}

// The journal sits at the end of the cross link's last element, the bearing at that of the coupler's.
TEST(AllFlexible, PosesCloseTheLoop) {
  const RunResult run = run_rpsup(all_flexible(), {.duration = 0.1});
  const std::size_t k = column(run, "t_s").size() - 1;
  const auto end_of = [&](const std::string& link, double length) -> Eigen::Vector3d {
    const auto at = [&](const char* part) { return column(run, "pose_" + link + part)[k]; };
    const Eigen::Quaterniond turn(at("_qw"), at("_qx"), at("_qy"), at("_qz"));
    return Eigen::Vector3d(at("_x_m"), at("_y_m"), at("_z_m")) + turn * Eigen::Vector3d(length, 0.0, 0.0);
  };
  const double gap = (end_of("1_3_3", 0.5 / 6.0) - end_of("2_2_3", 0.1 / 6.0)).norm();
  EXPECT_LT(gap, 0.26e-3);
  EXPECT_NEAR(gap, 1e-3 * std::hypot(column(run, "journal_x_mm")[k], column(run, "journal_y_mm")[k], column(run, "journal_z_mm")[k]), 1e-12);
  // The rod's origin is the crank's when it stands at 0.
  EXPECT_NEAR((end_of("1_2_0", 0.0) - end_of("1_1_0", column(run, "rod_displacement_m")[k])).norm(), 0.0, 1e-3);
  EXPECT_NEAR((end_of("1_2_3", 0.2 / 6.0) - end_of("1_3_0", 0.0)).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace engine
