// SPDX-License-Identifier: Apache-2.0
// The laws that a study may choose from: damping, stiffness and friction of the joint, each against its own closed form.

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "engine/clearance/cylinder_contact.h"
#include "engine/clearance/friction.h"
#include "engine/clearance/normal_law.h"
#include "engine/errors.h"
#include "engine/simulate.h"
#include "engine/simulate_rpsup.h"
#include "validation/contact/sliding_mass.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/runs.h"
#include "validation/support/simple_mechanisms.h"

namespace engine {
namespace {

using std::numbers::pi;
using validation::make_sliding_mass;
using validation::metric;
using validation::one_ring;
using validation::simulate_impact;

constexpr double kMass = 0.8;   // [kg]
constexpr double kSpeed = 0.1;  // [m/s]
constexpr double kGap = 37e-6;  // [m]

struct DampingCase {
  const char* name;
  NormalForceLaw law;
  double at_08;  ///< chi for k_r = 0.8, by hand
};
void PrintTo(const DampingCase& c, std::ostream* out) { *out << c.name; }
class Damping : public testing::TestWithParam<DampingCase> {};

TEST_P(Damping, HasItsPublishedFactor) {
  EXPECT_NEAR(calc_damping_factor(GetParam().law, 0.8), GetParam().at_08, 1e-12);
  EXPECT_EQ(calc_damping_factor(GetParam().law, 1.0), 0.0);
}

// c (1 + e) = ln((1 + c) / (1 - c e)) for every chi, whatever the stiffness and the mass.
TEST_P(Damping, ReboundsByTheClosedForm) {
  for (const double k_r : {0.9, 0.4}) {
    ClearanceParameters joint = one_ring();
    joint.chi = calc_damping_factor(GetParam().law, k_r);
    const double found = simulate_impact(make_sliding_mass(joint, kMass), kGap, kSpeed, validation::calc_hertz_time(joint.K, kMass, kSpeed)).speed;
    EXPECT_NEAR(found / kSpeed, validation::rebound_ratio(joint.chi), 1e-8) << k_r;
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, Damping,
                         testing::Values(DampingCase{"lankarani_nikravesh", NormalForceLaw::kLankaraniNikravesh, 0.27},
                                         DampingCase{"hunt_crossley", NormalForceLaw::kHuntCrossley, 0.3},
                                         DampingCase{"herbert_mcwhannell", NormalForceLaw::kHerbertMcWhannell, 1.2 / 3.36},
                                         DampingCase{"lee_wang", NormalForceLaw::kLeeWang, 0.15},
                                         DampingCase{"gonthier", NormalForceLaw::kGonthier, 0.45},
                                         DampingCase{"flores", NormalForceLaw::kFlores, 0.4},
                                         DampingCase{"hu_guo", NormalForceLaw::kHuGuo, 0.375},
                                         DampingCase{"carvalho_martins", NormalForceLaw::kCarvalhoMartins, 3.06 / 8.2}),
                         [](const auto& c) { return c.param.name; });

class LastRate : public validation::QuietObserver {
 public:
  void on_step(const Evaluation& /*start*/, const Evaluation& end) override { rate = end.qd[0]; }
  double rate = 0.0;
};

// A face is a linear spring. With the force cut at 0, T. Schwager and T. Poeschel, Granular Matter 9 (2007), Eq. (19):
// e = exp(-beta / omega (pi - atan(2 beta omega / (omega^2 - beta^2)))), beta = d / (2 m), omega^2 = k / m - beta^2.
TEST(KelvinVoigt, ReboundsFromAFaceByTheClosedForm) {
  constexpr double kReach = 1e-3;
  for (const double damping : {500.0, 5000.0}) {
    ClearanceParameters joint = one_ring();
    joint.c_a = kReach;
    joint.K_a = 1e8;
    joint.chi = 0.0;
    joint.damping = damping;
    Mechanism mass = make_sliding_mass(joint, kMass);
    mass.coordinates[0].axis = Axis::kZ;
    const double beta = 0.5 * damping / kMass;
    const double omega = std::sqrt(joint.K_a / kMass - beta * beta);
    // Its force jumps as the contact begins, inside a step: an error control that is too tight would never get beyond.
    const RunOptions options{.duration = kGap / kSpeed + 2.0 * pi / omega, .integrator = Integrator::kDopri5, .relative_tolerance = 1e-9,
                             .absolute_tolerance = 1e-10};
    LastRate observer;
    (void)validation::run_from(mass, options, Eigen::VectorXd::Constant(1, kReach - kGap), Eigen::VectorXd::Constant(1, kSpeed), observer);
    const double e = std::exp(-beta / omega * (pi - std::atan(2.0 * beta * omega / (omega * omega - beta * beta))));
    EXPECT_NEAR(-observer.rate / kSpeed, e, 1e-6) << damping;
  }
}

constexpr double kRigidity = 2.3e9;  // [N/m]
constexpr double kClearance = 0.25e-3;

class Cylinders : public testing::TestWithParam<StiffnessLaw> {};

TEST_P(Cylinders, AreTheirPublishedLaw) {
  const CylinderContact contact{GetParam(), kRigidity, kClearance};
  const double c = 1.0 / (pi * kRigidity);
  for (const double delta : {1e-9, 1e-7, 1e-6, 1e-5, 5e-5}) {
    const double F = contact.calc(delta).force;
    if (GetParam() == StiffnessLaw::kLiu) {
      EXPECT_NEAR(F / (0.5 * pi * kRigidity * delta * std::sqrt(delta / (2.0 * (kClearance + delta)))), 1.0, 1e-13) << delta;
      continue;
    }
    const double D_b = 10e-3, D_j = D_b - 2.0 * kClearance;
    const double b = 1.6 * std::sqrt(F * D_b * D_j / (2.0 * kClearance * kRigidity));
    const double expected = GetParam() == StiffnessLaw::kJohnson ? c * F * (std::log(4.0 * pi * kRigidity * kClearance / F) - 1.0)
                                                                 : c * F * (2.0 / 3.0 + std::log(4.0 * D_b * D_j / (b * b)));
    EXPECT_NEAR(expected / delta, 1.0, 1e-12) << delta;
  }
}

TEST_P(Cylinders, HaveTheSlopeAndTheEnergyOfTheirForce) {
  const CylinderContact contact{GetParam(), kRigidity, kClearance};
  for (const double delta : {1e-7, 3e-6, 4.9e-6, 5.1e-6, 5e-5}) {
    const double h = 1e-4 * delta;
    const ElasticForce at = contact.calc(delta);
    const ElasticForce less = contact.calc(delta - h);
    const ElasticForce more = contact.calc(delta + h);
    EXPECT_NEAR((more.force - less.force) / (2.0 * h) / at.slope, 1.0, 1e-7) << delta;
    EXPECT_NEAR((more.energy - less.energy) / (2.0 * h) / at.force, 1.0, 1e-7) << delta;
  }
}

TEST_P(Cylinders, EndWhereTheirForceWouldFall) {
  const CylinderContact contact{GetParam(), kRigidity, kClearance};
  if (GetParam() == StiffnessLaw::kLiu) {
    EXPECT_TRUE(std::isinf(contact.range()));
    EXPECT_TRUE(std::isfinite(contact.calc(1.0).force));
    return;
  }
  EXPECT_GT(contact.calc(0.999 * contact.range()).slope, 0.0);
  EXPECT_TRUE(std::isnan(contact.calc(1.001 * contact.range()).force));
}

// Without damping all that the mass brings is stored at the turn, and given back.
TEST_P(Cylinders, StoreAndReturnAnImpact) {
  ClearanceParameters joint = one_ring();
  joint.chi = 0.0;
  joint.cylinders = {GetParam(), kRigidity, joint.c_r};
  const validation::Impact impact = simulate_impact(make_sliding_mass(joint, kMass), kGap, kSpeed, 2e-4);
  EXPECT_NEAR(impact.speed / kSpeed, 1.0, 1e-8);
  EXPECT_NEAR(joint.cylinders.calc(impact.depth).energy / (0.5 * kMass * kSpeed * kSpeed), 1.0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Laws, Cylinders, testing::Values(StiffnessLaw::kJohnson, StiffnessLaw::kRadzimovsky, StiffnessLaw::kLiu));

const Eigen::Vector2d kAlong = Eigen::Vector2d(0.6, -0.8);

TEST(FrictionWithoutBristles, IsThatOfItsSpeedAlone) {
  FrictionParameters p{.mu_k = 0.2, .law = FrictionLaw::kCoulomb, .v_0 = 1e-3, .v_1 = 3e-3};
  const auto along = [&](double v) {
    const BristleForce f = calc_bristle_force(p, v * kAlong, {0.3, 0.1});
    EXPECT_EQ(f.bristle_rate, Eigen::Vector2d(0.0, 0.0));
    EXPECT_NEAR(f.force_ratio.norm(), std::abs(f.force_ratio.dot(kAlong)), 1e-15);
    return f.force_ratio.dot(kAlong);
  };
  EXPECT_NEAR(along(1e-3), 0.2 / std::numbers::sqrt2, 1e-15);
  EXPECT_NEAR(along(-1.0), -0.2, 1e-6);
  EXPECT_EQ(along(0.0), 0.0);
  p.law = FrictionLaw::kAmbrosio;
  EXPECT_EQ(along(0.9e-3), 0.0);
  EXPECT_NEAR(along(2e-3), 0.1, 1e-15);
  EXPECT_NEAR(along(-4e-3), -0.2, 1e-15);
}

// From rest F = mu (1 - exp(-sigma_0 x / mu)): Dahl's curve, however fast it is gone through.
TEST(Dahl, FollowsItsCurve) {
  const FrictionParameters p{.mu_s = 0.2, .mu_k = 0.2, .sigma_0 = 100.0, .sigma_1 = 0.0, .law = FrictionLaw::kDahl};
  for (const double x : {1e-4, 1e-3, 4e-3}) {
    const double F = 0.2 * (1.0 - std::exp(-100.0 * x / 0.2));
    const BristleForce f = calc_bristle_force(p, 0.05 * kAlong, F / 100.0 * kAlong);
    EXPECT_NEAR(f.force_ratio.dot(kAlong), F, 1e-15);
    EXPECT_NEAR(f.bristle_rate.dot(kAlong) / 0.05, std::exp(-100.0 * x / 0.2), 1e-14);  // dz/dx
  }
}

TEST(ElastoPlastic, DoesNotCreepBelowItsBreakAway) {
  const FrictionParameters p{.mu_s = 0.3, .mu_k = 0.2, .sigma_0 = 100.0, .v_s = 1e-3, .law = FrictionLaw::kElastoPlastic, .break_away = 0.7};
  const auto rate = [&](double v, double z) { return calc_bristle_force(p, v * kAlong, z * kAlong).bristle_rate.dot(kAlong); };
  const double steady = 2e-3;  // mu_k / sigma_0, far above the Stribeck velocity
  EXPECT_DOUBLE_EQ(rate(0.1, 0.69 * steady), 0.1);
  EXPECT_NEAR(rate(0.1, 0.85 * steady), 0.1 * (1.0 - 0.5 * 0.85), 1e-12);  // in the middle, half the decay
  EXPECT_NEAR(rate(0.1, steady), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(rate(-0.1, 0.85 * steady), -0.1);  // on its way back it is elastic
}

struct Choice {
  const char* name;
  std::function<void(RpsupParameters&)> choose;
};
void PrintTo(const Choice& c, std::ostream* out) { *out << c.name; }
class Choices : public testing::TestWithParam<Choice> {};

TEST_P(Choices, RunTheLinkageWithAClosedAccount) {
  RpsupParameters parameters = validation::across_rpsup();
  const RunOptions options{.duration = 0.25};
  const double usual = metric(validation::run_rpsup(parameters, options), "peak_slider_acceleration_whole_run_m_s2");
  GetParam().choose(parameters);
  const RunResult run = validation::run_rpsup(parameters, options);
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  EXPECT_LT(metric(run, "energy_residual"), 1e-5);
  EXPECT_GT(metric(run, "impact_count"), 5.0);
  EXPECT_NE(metric(run, "peak_slider_acceleration_whole_run_m_s2"), usual);
  // The implicit method's Jacobian knows the law: an explicit one finds the same.
  const RunResult other = validation::run_rpsup(parameters, {.duration = 0.25, .integrator = Integrator::kDopri5, .relative_tolerance = 1e-8,
                                                             .absolute_tolerance = 1e-9});
  const RunResult tight = validation::run_rpsup(parameters, {.duration = 0.25, .relative_tolerance = 1e-7, .absolute_tolerance = 1e-7});
  const double peak = metric(other, "peak_slider_acceleration_whole_run_m_s2");
  EXPECT_NEAR(metric(tight, "peak_slider_acceleration_whole_run_m_s2"), peak, 2e-4 * peak);
}

INSTANTIATE_TEST_SUITE_P(
    Laws, Choices,
    testing::Values(Choice{"flores", [](auto& p) { p.normal_law = NormalForceLaw::kFlores; }},
                    Choice{"kelvin_voigt", [](auto& p) { p.normal_law = NormalForceLaw::kKelvinVoigt; }},
                    Choice{"johnson", [](auto& p) { p.stiffness_law = StiffnessLaw::kJohnson; }},
                    Choice{"radzimovsky", [](auto& p) { p.stiffness_law = StiffnessLaw::kRadzimovsky; }},
                    Choice{"liu", [](auto& p) { p.stiffness_law = StiffnessLaw::kLiu; }},
                    Choice{"coulomb", [](auto& p) { p.friction = FrictionLaw::kCoulomb; }},
                    Choice{"ambrosio", [](auto& p) { p.friction = FrictionLaw::kAmbrosio; }},
                    Choice{"dahl", [](auto& p) { p.friction = FrictionLaw::kDahl; }},
                    Choice{"elasto_plastic", [](auto& p) { p.friction = FrictionLaw::kElastoPlastic; }}),
    [](const auto& c) { return c.param.name; });

TEST(StiffnessLaw, EndsTheRunWhereItNoLongerHolds) {
  RpsupParameters parameters = validation::across_rpsup();
  parameters.stiffness_law = StiffnessLaw::kJohnson;
  parameters.contact_stiffness_scale = 1e-6;
  const RunResult run = simulate_rpsup(parameters, {.duration = 1.0}, {});
  EXPECT_EQ(run.status, RunStatus::kContactRange);
  EXPECT_EQ(status_name(run.status), "contact_range");
  EXPECT_NE(run.detail.find("liu"), std::string::npos);
}

}  // namespace
}  // namespace engine
