// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/tolerance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/dynamics/motion_system.h"
#include "engine/integrate/energy_control.h"
#include "engine/model/mechanism.h"
#include "engine/model/rpsup.h"

namespace engine {
namespace {

/// A rod that turns about its end: 3 kg at 0.4 m from the pivot, radius of gyration 0.5 m.
Mechanism make_rod() {
  Mechanism m;
  m.coordinates.push_back({.name = "angle", .placement = {}, .axis = Axis::kZ, .mass = 3.0, .com = {0.4, 0.0, 0.0},
                           .inertia = Eigen::Vector3d(0.01, 0.75, 0.75).asDiagonal()});
  return m;
}

Evaluation evaluate_at_zero(MotionSystem& system) {
  Evaluation at = system.make_evaluation();
  const Eigen::VectorXd y = system.make_state(at.q, at.qd);
  Eigen::VectorXd f(y.size());
  EXPECT_EQ(system.calc_derivative(0.0, y, f, at), EvaluationStatus::kOk);
  return at;
}

TEST(Tolerance, MeasuresARotationAtTheRadiusOfGyrationOfWhatItCarries) {
  const Mechanism rod = make_rod();
  MotionSystem system(rod);
  const Evaluation at = evaluate_at_zero(system);
  const Eigen::VectorXd y = system.make_state(at.q, at.qd);
  Tolerance tolerance(1e-3, 1e-6);
  const Eigen::VectorXd error = Eigen::VectorXd::Constant(y.size(), 1e-5);
  EXPECT_NEAR(tolerance.measure(error, 0.0 * y, 0.0 * y, system.error_weights()), 10.0, 1e-12);
  tolerance.set_radii(rod, system.free_coordinates(), at.frames);
  EXPECT_NEAR(tolerance.measure(error, 0.0 * y, 0.0 * y, system.error_weights()), 5.0, 1e-12);
}

// The current of a winding and the integral of a controller are no velocities.
TEST(Tolerance, TakesNoSpeedFromACoordinateOfNoJoint) {
  Mechanism rod = make_rod();
  rod.coordinates.push_back({.name = "charge", .role = CoordinateRole::kCharge, .placement = {}, .axis = Axis::kZ, .mass = 1.0,
                             .inertia = 1e-3 * Eigen::Matrix3d::Identity()});
  MotionSystem system(rod);
  const Evaluation at = evaluate_at_zero(system);
  Tolerance tolerance(1e-3, 1e-6);
  tolerance.set_radii(rod, system.free_coordinates(), at.frames);
  EXPECT_NEAR(tolerance.calc_speed(Eigen::Vector2d(2.0, 0.0)), 2.0 * 0.5, 1e-12);
  EXPECT_EQ(tolerance.calc_speed(Eigen::Vector2d(0.0, 5.0)), 0.0);
}

TEST(Tolerance, AllowsCoordinatesNoMoreWhereThereAreMoreContactElements) {
  RpsupParameters parameters;
  const auto measure = [](MotionSystem& system, const Eigen::VectorXd& y) {
    Eigen::VectorXd error = Eigen::VectorXd::Zero(y.size());
    error.head(2 * system.free_count()).setConstant(1e-5);
    return Tolerance(1e-3, 1e-6).measure(error, 0.0 * y, 0.0 * y, system.error_weights());
  };
  const auto make_state = [](const MotionSystem& system) { return system.make_state(system.make_evaluation().q, system.make_evaluation().qd); };
  const Mechanism plain = build_rpsup(parameters).mechanism;
  MotionSystem continuum(plain);
  const double expected = measure(continuum, make_state(continuum));
  parameters.contact = ContactForm::kElements;
  for (const int count : {36, 720}) {
    parameters.radial_elements = count;
    const Mechanism mechanism = build_rpsup(parameters).mechanism;
    MotionSystem elements(mechanism);
    Eigen::VectorXd y = make_state(elements);
    EXPECT_NEAR(measure(elements, y), expected, 1e-12) << count;
    elements.widen_bristles(y);
    EXPECT_NEAR(measure(elements, y), expected, 1e-12) << count << ", widened";
  }
}

EnergyAccount account(double kinetic, double work) {
  return {.kinetic = kinetic, .drive_work = Eigen::VectorXd::Constant(1, work)};
}

TEST(EnergyControl, AllowsAStepAPartOfTheMeanPower) {
  const RunOptions options{.relative_tolerance = 1e-3, .absolute_tolerance = 1e-6};
  EnergyControl control(options, 0.0);
  control.accept(account(0.0, 0.0), account(5.0, 5.0));  // 10 J exchanged in 2 s
  const double imbalance = 1e-5;
  const double allowed = 0.25 * (1e-6 + 1e-3 * 5.0);  // [W]
  EXPECT_NEAR(control.measure(account(5.0, 5.0), account(6.0 + imbalance, 6.0), 2.0, 0.01), imbalance / (0.01 * allowed), 1e-6);
  EXPECT_NEAR(control.measure(account(5.0, 5.0), account(6.0, 6.0), 2.0, 0.01), 0.0, 1e-9);
}

}  // namespace
}  // namespace engine
