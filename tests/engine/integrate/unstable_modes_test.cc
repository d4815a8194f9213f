// SPDX-License-Identifier: Apache-2.0
// Unstable modes of systems with known eigenvalues; steppers that go on after another user has linearised
// their system.

#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "engine/integrate/odeint_steppers.h"
#include "engine/integrate/radau.h"
#include "engine/integrate/unstable_modes.h"
#include "tests/engine/pendulum.h"

namespace engine {
namespace {

/// A mass of 1 kg on a spring and a damper; negative ones push it on.
struct Oscillator {
  double stiffness;  ///< [N/m]
  double damping;    ///< [N s/m]
};

Instability find_among(const std::vector<Oscillator>& oscillators) {
  Mechanism m;
  for (const Oscillator& o : oscillators) {
    m.coordinates.push_back({.name = "slide",
                             .placement = {},
                             .motion = Motion::kTranslation,
                             .axis = Axis::kX,
                             .stiffness = o.stiffness,
                             .damping = o.damping,
                             .mass = 1.0,
                             .com = Eigen::Vector3d::Zero(),
                             .inertia = Eigen::Matrix3d::Identity()});
  }
  MotionSystem system(m);
  const auto n = static_cast<Eigen::Index>(oscillators.size());
  EXPECT_EQ(system.linearise(0.0, system.make_state(Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n))),
            EvaluationStatus::kOk);
  return UnstableModes(system.free_count()).find(system, 1.0);
}

constexpr double kFast = 1e8, kSlow = 1e6;  // stiffness of 1e4 and 1e3 rad/s

TEST(UnstableModes, FindsGrowthAndFrequency) {
  const Instability found = find_among({{kFast, -400.0}});
  EXPECT_NEAR(found.growth, 200.0, 1e-4);
  EXPECT_NEAR(found.frequency, std::sqrt(kFast - 200.0 * 200.0), 1e-4);
}

TEST(UnstableModes, FindsTheFastestGrowthAndTheHighestFrequency) {
  const Instability found = find_among({{kFast, -100.0}, {kSlow, -800.0}, {4.0 * kFast, 300.0}});
  EXPECT_NEAR(found.growth, 400.0, 1e-4);
  EXPECT_NEAR(found.frequency, std::sqrt(kFast - 50.0 * 50.0), 1e-4);
}

TEST(UnstableModes, LeavesOutStableAndMonotonicModes) {
  EXPECT_EQ(find_among({{kFast, 0.0}, {kSlow, 100.0}}).growth, 0.0);
  EXPECT_EQ(find_among({{-kSlow, 0.0}, {0.0, -100.0}}).growth, 0.0);
  EXPECT_EQ(find_among({{-kSlow, 0.0}, {0.0, -100.0}}).frequency, 0.0);
}

/// A method at the start of a motion, whose system others use between two of its tries.
template <class Method>
void expect_same_step_after_a_check(Shifts shifts) {
  const Mechanism mechanism = make_pendulum();
  MotionSystem system(mechanism);
  Tolerance tolerance(1e-6, 1e-6);
  StepPoint start, end, again;
  start.y = system.make_state(Eigen::Vector2d(1.0, -0.5), Eigen::Vector2d(3.0, -2.0));
  start.f = Eigen::VectorXd::Zero(start.y.size());
  start.at = end.at = again.at = system.make_evaluation();
  ASSERT_EQ(system.calc_derivative(0.0, start.y, start.f, start.at), EvaluationStatus::kOk);
  tolerance.set_radii(mechanism, system.free_coordinates(), start.at.frames);
  constexpr double kStep = 1e-3;
  Method method(tolerance);
  ASSERT_LE(method.try_step(system, start, kStep, end).error, 1.0);
  ASSERT_EQ(system.linearise(0.0, start.y, system.choose_newton_solver(shifts)), EvaluationStatus::kOk);
  (void)UnstableModes(system.free_count()).find(system, 1.0);
  method.jacobian_refreshed();
  ASSERT_LE(method.try_step(system, start, kStep, again).error, 1.0);
  EXPECT_EQ(again.y, end.y);
}

TEST(UnstableModes, LeavesRadauTheSameStep) {
  expect_same_step_after_a_check<Radau5>(Shifts::kRealAndComplex);
}

TEST(UnstableModes, LeavesRodasTheSameStep) { expect_same_step_after_a_check<Rodas5>(Shifts::kReal); }

}  // namespace
}  // namespace engine
