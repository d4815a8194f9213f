// SPDX-License-Identifier: Apache-2.0
// The recursive Newton solver, body by body, against the Newton matrix of all coordinates.

#include <algorithm>
#include <complex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/dynamics/motion_system.h"
#include "tests/engine/dynamics/moving_mechanism.h"

namespace engine {
namespace {

/// Those without constraints, and without springs between points.
std::vector<MechanismCase> open_chains() {
  std::vector<MechanismCase> cases = make_mechanism_cases();
  std::erase_if(cases, [](const MechanismCase& c) {
    const bool constrained =
        c.mechanism.drive_rows == DriveRows::kMultipliers || !c.mechanism.couplings.empty() ||
        std::ranges::any_of(c.mechanism.cut_joints, [](const CutJoint& joint) { return !joint.clearance; });
    return constrained || !c.mechanism.springs.empty() || !c.mechanism.actuations.empty();
  });
  return cases;
}

class OpenChains : public testing::TestWithParam<MechanismCase> {};

TEST_P(OpenChains, BodyByBodyIsTheSameAsByTheMatrix) {
  MovingMechanism moving(GetParam(), {});
  MotionSystem& system = moving.system;
  ASSERT_TRUE(system.can_solve_recursively());
  constexpr double kSame = 1e-7;  // a stiff contact is put on what moves without it, which costs digits: 1e-8
                                  // where a millimetre is pressed in
  for (const double shift : {3e2, 3e4, 3e6}) {
    Eigen::VectorXd right = moving.f;
    for (Eigen::Index i = 0; i < right.size(); ++i) right[i] += static_cast<double>(i % 5 - 2);
    Eigen::VectorXd solutions[2], times[2];
    for (const NewtonSolver solver : solvers_of(system)) {
      const bool bodies = solver == NewtonSolver::kRecursive;
      ASSERT_EQ(system.linearise(MovingMechanism::kTime, moving.y, solver), EvaluationStatus::kOk);
      ASSERT_TRUE(system.factor(shift));
      solutions[bodies] = right;
      system.solve_in_place(solutions[bodies]);
      times[bodies] = system.time_derivative();
    }
    EXPECT_EQ((times[1] - times[0]).cwiseAbs().maxCoeff(), 0.0);
    const Eigen::Index free = system.free_count();
    const auto expect_same = [&](Eigen::Index first, Eigen::Index count, const char* part) {
      const double scale = solutions[0].segment(first, count).cwiseAbs().maxCoeff();
      EXPECT_LE((solutions[1] - solutions[0]).segment(first, count).cwiseAbs().maxCoeff(), kSame * scale)
          << part << " at a shift of " << shift;
    };
    expect_same(0, free, "coordinates");
    expect_same(free, free, "rates");
    if (system.controlled_size() > 2 * free)
      expect_same(2 * free, system.controlled_size() - 2 * free, "bristles");
    expect_same(system.controlled_size(), right.size() - system.controlled_size(), "works");
  }
}

TEST_P(OpenChains, BodyByBodyIsTheSameAsByTheMatrixWithAComplexShift) {
  MovingMechanism moving(GetParam(), {});
  MotionSystem& system = moving.system;
  ASSERT_TRUE(system.can_solve_recursively());
  constexpr double kSame = 1e-7;  // as above
  const Eigen::Index free = system.free_count(), controlled = system.controlled_size();
  for (const std::complex<double> shift : {std::complex<double>(3e2, 4e2), {3e4, -4e4}, {3e6, 4e6}}) {
    Eigen::VectorXcd solutions[2];
    for (const NewtonSolver solver : solvers_of(system)) {
      ASSERT_EQ(system.linearise(MovingMechanism::kTime, moving.y, solver), EvaluationStatus::kOk);
      ASSERT_TRUE(system.factor(shift));
      Eigen::VectorXd real = moving.f, imag = moving.f.reverse();
      for (Eigen::Index i = 0; i < real.size(); ++i) imag[i] += static_cast<double>(i % 5 - 2);
      system.solve_in_place(real, imag);
      Eigen::VectorXcd& x = solutions[solver == NewtonSolver::kRecursive];
      x.resize(real.size());
      x.real() = real;
      x.imag() = imag;
    }
    const auto expect_same = [&](Eigen::Index first, Eigen::Index count, const char* part) {
      if (count == 0) return;
      const double scale = solutions[0].segment(first, count).cwiseAbs().maxCoeff();
      EXPECT_LE((solutions[1] - solutions[0]).segment(first, count).cwiseAbs().maxCoeff(), kSame * scale)
          << part << " at a shift of " << shift;
    };
    expect_same(0, free, "coordinates");
    expect_same(free, free, "rates");
    expect_same(2 * free, controlled - 2 * free, "bristles");
    expect_same(controlled, solutions[0].size() - controlled, "works");
  }
}

// A step that is tried again is factored anew, after its stages have been evaluated elsewhere.
TEST_P(OpenChains, WhatIsHeldOutlivesOtherEvaluations) {
  MovingMechanism moving(GetParam(), {});
  MotionSystem& system = moving.system;
  const auto solve = [&](double shift, const auto& between) {
    Eigen::VectorXd x = moving.f;
    EXPECT_TRUE(system.factor(shift));
    between();
    system.solve_in_place(x);
    return x;
  };
  const auto linearise = [&] {
    ASSERT_EQ(system.linearise(MovingMechanism::kTime, moving.y, NewtonSolver::kRecursive),
              EvaluationStatus::kOk);
  };
  linearise();
  const Eigen::VectorXd first = solve(1e5, [] {}), second = solve(3e4, [] {});
  const auto go_elsewhere = [&] {
    Eigen::VectorXd other = moving.y, rates = moving.f;
    other.head(system.free_count()).array() += 1e-9;
    moving.evaluate(MovingMechanism::kTime + 1e-7, other, rates);
  };
  linearise();
  EXPECT_EQ(solve(1e5, go_elsewhere), first);
  go_elsewhere();
  EXPECT_EQ(solve(3e4, go_elsewhere), second);
}

// As radau5 does: a real and a complex shift are factored, both serve for several steps.
TEST_P(OpenChains, ARealAndAComplexShiftAreHeldSideBySide) {
  MovingMechanism moving(GetParam(), {});
  MotionSystem& system = moving.system;
  constexpr std::complex<double> kShift(2e4, 3e4);
  const auto linearise = [&] {
    ASSERT_EQ(system.linearise(MovingMechanism::kTime, moving.y, NewtonSolver::kRecursive),
              EvaluationStatus::kOk);
  };
  const auto solve_real = [&] {
    Eigen::VectorXd x = moving.f;
    system.solve_in_place(x);
    return x;
  };
  const auto solve_complex = [&] {
    Eigen::VectorXd real = moving.f, imag = moving.f.reverse();
    system.solve_in_place(real, imag);
    return Eigen::VectorXd(real + imag);
  };
  linearise();
  ASSERT_TRUE(system.factor(1e5));
  const Eigen::VectorXd real = solve_real();
  linearise();
  ASSERT_TRUE(system.factor(kShift));
  const Eigen::VectorXd complex = solve_complex();
  linearise();
  ASSERT_TRUE(system.factor(1e5) && system.factor(kShift));
  for (int step = 0; step < 2; ++step) {
    EXPECT_EQ(solve_real(), real);
    EXPECT_EQ(solve_complex(), complex);
    Eigen::VectorXd other = moving.y, rates = moving.f;
    other.head(system.free_count()).array() += 1e-9;
    moving.evaluate(MovingMechanism::kTime + 1e-7, other, rates);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, OpenChains, testing::ValuesIn(open_chains()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace engine
