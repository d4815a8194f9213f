// SPDX-License-Identifier: Apache-2.0
// Vibrations that grow, found where their eigenvalues are known; and methods of integration that go on after others have used their system.

#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "engine/integrate/fed_vibrations.h"
#include "engine/integrate/odeint_steppers.h"
#include "engine/integrate/radau.h"
#include "tests/engine/pendulum.h"

namespace engine {
namespace {

/// A mass of 1 kg on a spring and a damper; negative ones push it on.
struct Oscillator {
  double stiffness;  ///< [N/m]
  double damping;    ///< [N s/m]
};

FedVibration find_among(const std::vector<Oscillator>& oscillators) {
  Mechanism m;
  for (const Oscillator& o : oscillators) {
    m.coordinates.push_back({.name = "slide", .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kX, .stiffness = o.stiffness,
                             .damping = o.damping, .mass = 1.0, .com = Eigen::Vector3d::Zero(), .inertia = Eigen::Matrix3d::Identity()});
  }
  MotionSystem system(m);
  const auto n = static_cast<Eigen::Index>(oscillators.size());
  EXPECT_EQ(system.linearise(0.0, system.make_state(Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n))), EvaluationStatus::kOk);
  return FedVibrations().find(system);
}

constexpr double kFast = 1e8, kSlow = 1e6;  // stiffness of 1e4 and 1e3 rad/s

TEST(FedVibrations, FindsGrowthAndFrequency) {
  const FedVibration found = find_among({{kFast, -400.0}});
  EXPECT_NEAR(found.growth, 200.0, 1e-4);
  EXPECT_NEAR(found.frequency, std::sqrt(kFast - 200.0 * 200.0), 1e-4);
}

TEST(FedVibrations, NamesTheFastestGrowthAndTheHighestFrequency) {
  const FedVibration found = find_among({{kFast, -100.0}, {kSlow, -800.0}, {4.0 * kFast, 300.0}});
  EXPECT_NEAR(found.growth, 400.0, 1e-4);
  EXPECT_NEAR(found.frequency, std::sqrt(kFast - 50.0 * 50.0), 1e-4);
}

TEST(FedVibrations, LeavesOutWhatDoesNotGrowOrDoesNotVibrate) {
  EXPECT_EQ(find_among({{kFast, 0.0}, {kSlow, 100.0}}).growth, 0.0);
  EXPECT_EQ(find_among({{-kSlow, 0.0}, {0.0, -100.0}}).growth, 0.0);
  EXPECT_EQ(find_among({{-kSlow, 0.0}, {0.0, -100.0}}).frequency, 0.0);
}

/// A method at the start of a motion, whose system others use between two of its tries.
template <class Method>
void expect_same_step_after_a_look(Shifts shifts) {
  const Mechanism mechanism = make_pendulum();
  MotionSystem system(mechanism);
  Tolerance tolerance(1e-6, 1e-6);
  StepEnd start, end, again;
  start.y = system.make_state(Eigen::Vector2d(1.0, -0.5), Eigen::Vector2d(3.0, -2.0));
  start.f = Eigen::VectorXd::Zero(start.y.size());
  start.at = end.at = again.at = system.make_evaluation();
  ASSERT_EQ(system.calc_derivative(0.0, start.y, start.f, start.at), EvaluationStatus::kOk);
  tolerance.set_radii(mechanism, system.free_coordinates(), start.at.frames);
  constexpr double kStep = 1e-3;
  Method method(tolerance);
  ASSERT_LE(method.try_step(system, start, kStep, end).error, 1.0);
  ASSERT_EQ(system.linearise(0.0, start.y, system.choose_newton_solver(shifts)), EvaluationStatus::kOk);
  (void)FedVibrations().find(system);
  method.jacobian_refreshed();
  ASSERT_LE(method.try_step(system, start, kStep, again).error, 1.0);
  EXPECT_EQ(again.y, end.y);
}

TEST(FedVibrations, LeavesRadauTheSameStep) { expect_same_step_after_a_look<Radau5>(Shifts::kRealAndComplex); }

TEST(FedVibrations, LeavesRodasTheSameStep) { expect_same_step_after_a_look<Rodas5>(Shifts::kReal); }

}  // namespace
}  // namespace engine
