// Without clearance and with a rigid coupler the motion is geometry: z^(2,1) = r cos psi + sqrt(l^2 - 0.2^2 - r^2 sin^2 psi).

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/simulate_rpsup.h"
#include "engine/model/drive_law.h"
#include "tests/support/rpsup_runs.h"

namespace engine {
namespace {

using support::column;

double closed_form(double omega, double t) {
  const double psi = calc_driven_motion(RunUp{omega, 2.0}, t).q;
  const double r = 0.2 + calc_driven_motion(RiseReturnPause{0.05, 0.5, 0.5}, t).q;
  return r * std::cos(psi) + std::sqrt(0.25 - 0.04 - std::pow(r * std::sin(psi), 2));
}

/// Its second derivative by differences of order 6 (h = 1e-3: about 1e-9 of the value from rounding, less from the order).
double closed_form_acceleration(double omega, double t) {
  constexpr double h = 1e-3;
  const auto z = [&](int k) { return closed_form(omega, t + k * h); };
  return ((z(3) + z(-3)) / 90.0 - 3.0 * (z(2) + z(-2)) / 20.0 + 1.5 * (z(1) + z(-1)) - 49.0 / 18.0 * z(0)) / (h * h);
}

/// Largest |acceleration| for t in [2, 5], by sampling 10 times finer than the differences resolve.
double closed_form_peak(double omega) {
  double peak = 0.0;
  for (int k = 40; k < 49'960; ++k) {
    const double t = 2.0 + 3.0 * k / 50'000.0;
    peak = std::max(peak, std::abs(closed_form_acceleration(omega, t)));
  }
  return peak;
}

class IdealLinkage : public testing::TestWithParam<double> {};

TEST_P(IdealLinkage, FollowsTheClosedForm) {
  RpsupParameters parameters;
  parameters.c_r = 0.0;
  parameters.crank_velocity = GetParam();
  const RunResult run = simulate_rpsup(parameters, {}, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  const auto& t = support::column(run, "t_s");
  const auto& z = support::column(run, "slider_position_m");
  ASSERT_EQ(t.size(), 5001u);
  double worst = 0.0;
  for (std::size_t k = 0; k < t.size(); ++k) worst = std::max(worst, std::abs(z[k] - closed_form(GetParam(), t[k])));
  EXPECT_LT(worst, 1e-12);  // rounding of positions near 1 m; the service promises 1e-9

  const double peak = closed_form_peak(GetParam());
  EXPECT_NEAR(support::metric(run, "peak_slider_acceleration_m_s2"), peak, 1e-6 * peak);
  EXPECT_NEAR(support::metric(run, "ideal_peak_slider_acceleration_m_s2"), peak, 1e-6 * peak);
  EXPECT_LT(support::metric(run, "energy_residual"), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(CrankVelocities, IdealLinkage, testing::Values(5.0, 10.0, 12.0, 15.0));

// The paper's way to the same motion: multipliers, stabilisation, fixed steps.
TEST(IdealLinkage, IntegratedWithMultipliersItFollowsTheClosedForm) {
  RpsupParameters parameters;
  parameters.c_r = 0.0;
  RunOptions options;
  options.duration = 3.0;
  options.integrator = Integrator::kRk4;
  options.step = 1e-4;
  for (const DriveEnforcement drive : {DriveEnforcement::kPrescribed, DriveEnforcement::kBaumgarte}) {
    parameters.drive = drive;
    const RunResult run = simulate_rpsup(parameters, options, {});
    ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
    const auto& t = support::column(run, "t_s");
    const auto& z = support::column(run, "slider_position_m");
    double worst = 0.0;
    for (std::size_t k = 0; k < t.size(); ++k) worst = std::max(worst, std::abs(z[k] - closed_form(10.0, t[k])));
    // Local errors of (1e-4 s)^5, damped by Baumgarte's 100 1/s.
    EXPECT_LT(worst, 1e-11);
    EXPECT_LT(support::metric(run, "energy_residual"), 1e-9);
  }
}

// Statics: with the drives at rest the crank holds the weight of the chain at its arms. Slider and cross link rest on their guide.
TEST(IdealLinkage, AtRestTheCrankCarriesTheWeight) {
  RpsupParameters parameters;
  parameters.c_r = 0.0;
  parameters.crank_velocity = 0.0;
  parameters.rod_stroke = 0.0;
  RunOptions options;
  options.duration = 0.01;
  const RunResult run = simulate_rpsup(parameters, options, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  // Links (1,1) and (1,2) hang at 0.1 m, half of the coupler at 0.2 m: the other half is carried by the guide through the joint.
  const auto& links = parameters.links;
  const double torque = 9.81 * (0.1 * links[0].mass + 0.1 * links[1].mass + 0.2 * 0.5 * links[2].mass);
  EXPECT_NEAR(support::column(run, "crank_torque_n_m").front(), torque, 1e-12);
  EXPECT_NEAR(support::column(run, "reaction_y_n").front(), -0.5 * 9.81 * links[2].mass, 1e-12);
  EXPECT_NEAR(support::column(run, "rod_force_n").front(), 0.0, 1e-12);
}

// Virtual work: at every instant the drives' power is the change of the links' energy.
TEST(IdealLinkage, DrivesDoTheWorkThatTheLinksTake) {
  RpsupParameters parameters;
  parameters.c_r = 0.0;
  const RunResult run = simulate_rpsup(parameters, {}, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  const auto& kinetic = support::column(run, "kinetic_energy_j");
  const auto& potential = support::column(run, "potential_energy_j");
  const auto& torque = support::column(run, "crank_torque_n_m");
  const auto& omega = support::column(run, "crank_velocity_rad_s");
  const auto& force = support::column(run, "rod_force_n");
  const auto& rod = support::column(run, "rod_displacement_m");
  for (std::size_t k = 2100; k < 4900; k += 37) {
    const double dt = 1e-3;
    const auto energy = [&](std::size_t i) { return kinetic[i] + potential[i]; };
    const double change = (8.0 * (energy(k + 1) - energy(k - 1)) - (energy(k + 2) - energy(k - 2))) / (12.0 * dt);
    const double rod_velocity = (8.0 * (rod[k + 1] - rod[k - 1]) - (rod[k + 2] - rod[k - 2])) / (12.0 * dt);
    EXPECT_NEAR(torque[k] * omega[k] + force[k] * rod_velocity, change, 2e-3) << k;  // of up to 70 W; differences of order 4
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
  EXPECT_LT(worst, 1e-8);  // the cubic in a step of 0.25 ms
}

}  // namespace
}  // namespace engine
