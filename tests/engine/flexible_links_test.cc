// Crank, rod and cross link as flexible links: beam theory, the rigid limit, and that all methods and drives cope with them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/model/rpsup.h"
#include "engine/simulate_rpsup.h"
#include "engine/validation/flexibility/rods.h"
#include "engine/validation/support/runs.h"

namespace engine {
namespace {

using validation::column;
using validation::metric;
using validation::run_rpsup;

LinkInertia& link_of(RpsupParameters& p, Link link) { return p.links[static_cast<std::size_t>(link)]; }

/// With a cross link of this length: the table's tube, 20/15 mm, cut to it.
RpsupParameters with_cross(double length) {
  RpsupParameters p;
  const LinkInertia tube = rod_inertia(1.07 * length, length, 8.377e-5 * length);
  p.cross_length = length;
  link_of(p, Link::k22) = {tube.mass, {tube.inertia.y(), tube.inertia.z(), tube.inertia.x()}};
  return p;
}

RpsupParameters all_flexible() {
  RpsupParameters p = with_cross(0.1);
  p.coupler = p.crank.model = p.rod.model = p.cross.model = LinkModel::kFlexible;
  p.run_up = 0.1;
  return p;
}

/// One of the links that may be flexible.
struct LinkCase {
  const char* name;
  Link link;
  RoundLink RpsupParameters::*form;
  double RpsupParameters::*length;
};
void PrintTo(const LinkCase& c, std::ostream* out) { *out << c.name; }

class FlexibleLinks : public testing::TestWithParam<LinkCase> {
 protected:
  RpsupParameters make(int segments) const {
    RpsupParameters p = with_cross(0.1);
    RoundLink& form = p.*GetParam().form;
    form.model = LinkModel::kFlexible;
    form.elements = segments + 1;
    return p;
  }
};

double calc_EI(const RoundLink& form) {
  return 2.1e11 * std::numbers::pi * (std::pow(form.diameter, 4) - std::pow(form.inner_diameter, 4)) / 64.0;
}

/// The link alone, its first element fixed to the ground.
Mechanism clamp(const Rpsup& rpsup) {
  const BentLink& link = rpsup.layout.bent.at(0);
  const FrameIndex first = link.root.frame + 1;
  Mechanism clamped;
  for (FrameIndex i = first; i <= link.tip.frame; ++i) {
    Coordinate c = rpsup.mechanism.coordinates[static_cast<std::size_t>(i)];
    c.parent = i == first ? kGround : c.parent - first;
    clamped.coordinates.push_back(c);
  }
  return clamped;
}

// f = (1.875104 / l)^2 / (2 pi) sqrt(E I l / m) of a clamped slender beam (Euler and Bernoulli); the division converges with the square of an
// element's length.
TEST_P(FlexibleLinks, HaveTheFirstFrequencyOfAClampedBeam) {
  const auto error_with = [&](int segments) {
    RpsupParameters p = make(segments);
    LinkInertia& inertia = link_of(p, GetParam().link);
    inertia.inertia *= 1e-4;  // hardly any rotary inertia; across the link the divided beam has that of its mass and length
    const double l = p.*GetParam().length;
    const double f = std::pow(1.8751040687 / l, 2) * std::sqrt(calc_EI(p.*GetParam().form) * l / inertia.mass) / (2.0 * std::numbers::pi);
    const Mechanism beam = clamp(build_rpsup(p));
    const Eigen::VectorXd found = validation::calc_frequencies(validation::calc_mass_matrix(beam), validation::stiffness_matrix(beam), {});
    return found[0] / f - 1.0;
  };
  const double coarse = error_with(8);
  const double fine = error_with(16);
  EXPECT_LT(std::abs(fine), 2e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

TEST_P(FlexibleLinks, DoWithFewElementsAsTheCouplerDoes) {
  RpsupParameters p = make(3);
  p.run_up = 0.1;
  const RunResult run = run_rpsup(p, {.duration = 0.3});
  EXPECT_LT(metric(run, "energy_residual"), 1e-6);
  EXPECT_GT(metric(run, "structural_loss_j"), 0.0);
}

// What a beam ten thousand times stiffer does is what a rigid one does: the crank's moved guide and the cross link's turned frame with it.
TEST_P(FlexibleLinks, GoOverIntoTheRigidOnes) {
  RpsupParameters p = make(3);
  p.c_r = 0.0;
  p.run_up = 0.1;
  p.youngs_modulus *= 1e4;
  p.shear_modulus *= 1e4;
  const RunOptions options{.duration = 0.3, .output_rate = 100.0};
  const RunResult flexible = run_rpsup(p, options);
  (p.*GetParam().form).model = LinkModel::kRigid;
  const RunResult rigid = run_rpsup(p, options);
  for (const auto& [key, allowed] : {std::pair{"slider_position_m", 1e-7}, {"pose_1_3_x_m", 1e-7}, {"pose_1_3_qz", 1e-6}}) {
    const std::vector<double>& a = column(flexible, key);
    const std::vector<double>& b = column(rigid, key);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], allowed) << key << " at " << k;
  }
  EXPECT_NEAR(metric(flexible, "rms_slider_acceleration_m_s2"), metric(rigid, "rms_slider_acceleration_m_s2"), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Engine, FlexibleLinks,
                         testing::Values(LinkCase{"crank", Link::k11, &RpsupParameters::crank, &RpsupParameters::crank_length},
                                         LinkCase{"rod", Link::k12, &RpsupParameters::rod, &RpsupParameters::rod_length},
                                         LinkCase{"cross", Link::k22, &RpsupParameters::cross, &RpsupParameters::cross_length}),
                         [](const auto& c) { return std::string(c.param.name); });

/// Standing still with the crank along x, as far damped as it takes to come to rest.
RpsupParameters standing() {
  RpsupParameters p;
  p.c_r = 0.0;
  p.crank_velocity = 0.0;
  p.rod_stroke = 0.0;
  p.crank.damping_ratio = p.rod.damping_ratio = 1.0;
  return p;
}

/// Sag of a clamped beam's end under its own weight, an end load and an end moment.
double calc_sag(double weight, double force, double moment, double l, double EI) {
  return (weight * l * l * l / 8.0 + force * l * l * l / 3.0 + moment * l * l / 2.0) / EI;
}

// The crank's end carries the rod, whose weight acts in the middle of the rod, and half of the coupler's.
TEST(FlexibleCrank, SagsAsABeamUnderItsWeightAndItsLoads) {
  constexpr double g = 9.81;
  RpsupParameters p = standing();
  p.crank.model = LinkModel::kFlexible;
  p.crank.elements = 17;
  p.rod_length = 0.3;  // its middle is 0.15 m from the crank's origin, the ball 0.1 m before the crank's end
  link_of(p, Link::k12) = rod_inertia(0.6, 0.3, 3e-5);
  const RunResult run = run_rpsup(p, {.duration = 0.15, .output_rate = 100.0});
  const double rod = 0.6 * g, ball = 0.5 * 0.306 * g;
  const double expected = calc_sag(0.471 * g, rod + ball, -0.05 * rod + 0.1 * ball, 0.2, calc_EI(p.crank));
  EXPECT_NEAR(column(run, "crank_deflection_mm").back(), 1e3 * expected, 3e-3 * 1e3 * expected);  // of 16 segments: 1 / (2 n^2)
}

TEST(FlexibleRod, SagsAsABeamUnderItsWeightAndTheCouplers) {
  constexpr double g = 9.81;
  RpsupParameters p = standing();
  p.rod.model = LinkModel::kFlexible;
  p.rod.elements = 17;
  const RunResult run = run_rpsup(p, {.duration = 0.15, .output_rate = 100.0});
  const double expected = calc_sag(0.490 * g, 0.5 * 0.306 * g, 0.0, 0.2, calc_EI(p.rod));
  EXPECT_NEAR(column(run, "rod_deflection_mm").back(), 1e3 * expected, 3e-3 * 1e3 * expected);
}

// z = r cos psi + sqrt(l^2 - h^2 - z_g^2 + a^2), h the ball's height: the cross link's end goes round the guide at its length a.
TEST(CrossLink, OfALengthMovesTheSliderByItsClosedForm) {
  RpsupParameters p = with_cross(0.12);
  p.c_r = 0.0;
  p.run_up = 0.1;
  p.guide_offset_y = 0.03;
  const RunResult run = run_rpsup(p, {.duration = 1.0, .output_rate = 50.0});
  for (std::size_t k = 0; k < column(run, "t_s").size(); ++k) {
    const double psi = column(run, "crank_angle_rad")[k];
    const double r = 0.2 + column(run, "rod_displacement_m")[k];
    const double height = r * std::sin(psi) - 0.03;
    EXPECT_NEAR(column(run, "slider_position_m")[k], r * std::cos(psi) + std::sqrt(0.25 - height * height - 0.04 + 0.0144), 1e-9) << k;
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
  for (const Integrator integrator : {Integrator::kRodas5, Integrator::kRodas4, Integrator::kRk4}) {
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
