// SPDX-License-Identifier: Apache-2.0
// The Jacobian of the equations of motion against differences of themselves, and the instruction sets against
// each other.

#include <algorithm>
#include <complex>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "engine/dynamics/motion_system.h"
#include "tests/engine/dynamics/moving_mechanism.h"

namespace engine {
namespace {

class Linearisation : public testing::TestWithParam<MechanismCase> {};

TEST_P(Linearisation, IsTheDerivativeInEveryDirection) {
  MovingMechanism moving(GetParam(), {});
  MotionSystem& system = moving.system;
  const Eigen::VectorXd by_time = moving.differ(-1, 10.0 * GetParam().step);
  std::vector<Eigen::VectorXd> columns;
  for (Eigen::Index j = 0; j < moving.y.size(); ++j)
    columns.push_back(moving.differ(j, j < system.free_count()       ? GetParam().step
                                       : j < 2 * system.free_count() ? 1e-5
                                                                     : 1e-7));
  for (const NewtonSolver solver : solvers_of(system)) {
    ASSERT_EQ(system.linearise(MovingMechanism::kTime, moving.y, solver), EvaluationStatus::kOk);
    EXPECT_LE((system.time_derivative() - by_time).cwiseAbs().maxCoeff(),
              2e-6 * by_time.cwiseAbs().maxCoeff());  // 0 without drives
    // (shift 1 - J) is known by its inverse only: what it makes of its own columns, taken by differences, is
    // a unit vector.
    constexpr double kShift = 3e4;
    ASSERT_TRUE(system.factor(kShift));
    for (Eigen::Index j = 0; j < moving.y.size(); ++j) {
      Eigen::VectorXd x = -columns[static_cast<std::size_t>(j)];
      x[j] += kShift;
      const double scale = x.cwiseAbs().maxCoeff() / kShift;
      system.solve_in_place(x);
      x[j] -= 1.0;
      EXPECT_LT(x.cwiseAbs().maxCoeff(), 2e-6 * std::max(1.0, scale)) << "column " << j;
    }
  }
}

/// The same of a complex shift: (shift 1 - J) (x + i y) with x = 1 in one place and y = 1 in the next one.
TEST_P(Linearisation, IsTheDerivativeWithAComplexShift) {
  MovingMechanism moving(GetParam(), {});
  MotionSystem& system = moving.system;
  const auto column = [&](Eigen::Index j) {
    return moving.differ(j, j < system.free_count()       ? GetParam().step
                            : j < 2 * system.free_count() ? 1e-5
                                                          : 1e-7);
  };
  constexpr std::complex<double> kShift(2e4, 3e4);
  std::vector<Eigen::VectorXd> columns;
  for (Eigen::Index j = 0; j < moving.y.size(); ++j) columns.push_back(column(j));
  for (const NewtonSolver solver : solvers_of(system)) {
    ASSERT_EQ(system.linearise(MovingMechanism::kTime, moving.y, solver), EvaluationStatus::kOk);
    ASSERT_TRUE(system.factor(kShift));
    for (Eigen::Index j = 0; j + 1 < moving.y.size(); ++j) {
      Eigen::VectorXd real = -columns[static_cast<std::size_t>(j)],
                      imag = -columns[static_cast<std::size_t>(j) + 1];
      real[j] += kShift.real();
      real[j + 1] -= kShift.imag();
      imag[j] += kShift.imag();
      imag[j + 1] += kShift.real();
      const double scale =
          std::max(real.cwiseAbs().maxCoeff(), imag.cwiseAbs().maxCoeff()) / std::abs(kShift);
      system.solve_in_place(real, imag);
      real[j] -= 1.0;
      imag[j + 1] -= 1.0;
      EXPECT_LT(real.cwiseAbs().maxCoeff() + imag.cwiseAbs().maxCoeff(), 4e-6 * std::max(1.0, scale))
          << "column " << j;
    }
  }
}

// A load of nothing on a body has the same mechanism evaluated by the code for any tree.
TEST(SpecialisedTopology, GivesTheRatesOfAnyTree) {
  std::vector<MechanismCase> cases = make_mechanism_cases();
  std::erase_if(cases, [](const MechanismCase& c) {
    return c.name.find("guide") == std::string::npos && c.name != "forced" && c.name != "controlled" &&
           c.name != "motorised";
  });
  cases.push_back(*std::ranges::find(
      cases, "forced",
      &MechanismCase::name));  // with a wheel of its own, where a motor would have its winding
  cases.back().name = "flywheel";
  Coordinate& wheel = cases.back().mechanism.coordinates.emplace_back();
  wheel.name = "wheel";
  wheel.start = 0.3;
  wheel.start_rate = 2.0;
  wheel.stiffness = 7.0;
  wheel.mass = 3.0;
  wheel.inertia = Eigen::Vector3d(0.5, 0.2, 0.2).asDiagonal();
  for (const MechanismCase& c : cases) {
    MechanismCase general = c;
    general.mechanism.body_loads.push_back({.frame = 0, .law = Constant{0.0}});
    const MovingMechanism special(c, {}), any(general, {});
    const Eigen::Index size = special.system.controlled_size();
    ASSERT_EQ(size, any.system.controlled_size()) << c.name;
    EXPECT_EQ(special.y.head(size), any.y.head(size)) << c.name;
    const double scale = any.f.head(size).cwiseAbs().maxCoeff();
    EXPECT_LT((special.f.head(size) - any.f.head(size)).cwiseAbs().maxCoeff(), 1e-10 * scale) << c.name;
    EXPECT_GT(scale, 1.0) << c.name;
  }
}

TEST(LinearisationAfterAnother, LeavesNothingOfTheOneBeforeBehind) {
  std::vector<MechanismCase> odd_rings = make_mechanism_cases();
  std::erase_if(odd_rings,
                [](const MechanismCase& c) { return c.name != "odd_rings" && c.name != "odd_rings_apart"; });
  ASSERT_EQ(odd_rings.size(), 2u);
  MovingMechanism many(odd_rings[0], {}), few(odd_rings[1], {});  // of one mechanism
  for (const Eigen::VectorXd* y : {&many.y, &few.y})
    ASSERT_EQ(many.system.linearise(MovingMechanism::kTime, *y), EvaluationStatus::kOk);
  ASSERT_EQ(few.system.linearise(MovingMechanism::kTime, few.y), EvaluationStatus::kOk);
  ASSERT_TRUE(many.system.factor(3e4) && few.system.factor(3e4));
  Eigen::VectorXd after_another = few.f, alone = few.f;
  many.system.solve_in_place(after_another);
  few.system.solve_in_place(alone);
  EXPECT_EQ(after_another, alone);
}

TEST_P(Linearisation, AndTheRatesAreTheSameBytesWithEveryInstructionSet) {
  if (instruction_sets().size() < 2) GTEST_SKIP() << "compiled for one instruction set alone";
  MovingMechanism first(GetParam(), instruction_sets().front());
  for (const std::string_view set : instruction_sets()) {
    MovingMechanism other(GetParam(), set);
    EXPECT_EQ((first.f - other.f).cwiseAbs().maxCoeff(), 0.0) << set;
    for (const NewtonSolver solver : solvers_of(first.system)) {
      ASSERT_EQ(first.system.linearise(MovingMechanism::kTime, first.y, solver), EvaluationStatus::kOk);
      ASSERT_EQ(other.system.linearise(MovingMechanism::kTime, other.y, solver), EvaluationStatus::kOk);
      EXPECT_EQ((first.system.time_derivative() - other.system.time_derivative()).cwiseAbs().maxCoeff(), 0.0)
          << set;
      Eigen::VectorXd x = first.f;
      Eigen::VectorXd y = first.f;
      ASSERT_TRUE(first.system.factor(1e5) && other.system.factor(1e5));
      first.system.solve_in_place(x);
      other.system.solve_in_place(y);
      EXPECT_EQ((x - y).cwiseAbs().maxCoeff(), 0.0) << set;
      constexpr std::complex<double> kComplexShift(2e4, 3e4);
      Eigen::VectorXd x_imag = first.f.reverse(), y_imag = x_imag;
      ASSERT_TRUE(first.system.factor(kComplexShift) && other.system.factor(kComplexShift));
      first.system.solve_in_place(x, x_imag);
      other.system.solve_in_place(y, y_imag);
      EXPECT_EQ((x - y).cwiseAbs().maxCoeff() + (x_imag - y_imag).cwiseAbs().maxCoeff(), 0.0) << set;
    }
  }
}

TEST_P(Linearisation, TheRatesAreTheSameBytesWhetherAllIsKeptOrNot) {
  for (const std::string_view set : instruction_sets()) {
    MovingMechanism moving(GetParam(), set);
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(moving.f.size());
    Evaluation at = moving.system.make_evaluation();
    ASSERT_EQ(moving.system.calc_derivative(MovingMechanism::kTime, moving.y, rates, at),
              EvaluationStatus::kOk);
    EXPECT_EQ((moving.f - rates).cwiseAbs().maxCoeff(), 0.0) << set;
  }
}

/// The linkage without clearance that code is specialised for, and others that look like it.
std::vector<MechanismCase> ideal_linkages() {
  std::vector<MechanismCase> cases = make_mechanism_cases();
  std::erase_if(cases,
                [](const MechanismCase& c) { return c.name != "ideal_flexible" && c.name != "ideal_rigid"; });
  for (const std::size_t k : {0u, 1u}) {
    MechanismCase universal = cases.at(k), dependent = cases.at(k);
    universal.name += "_universal";
    universal.mechanism.cut_joints[0].kind = CutKind::kUniversal;
    dependent.name += "_dependent";
    dependent.mechanism.minimum_norm_multipliers = true;
    cases.push_back(universal);
    cases.push_back(dependent);
  }
  return cases;
}

class Specialised : public testing::TestWithParam<MechanismCase> {};

// A spring without stiffness makes a linkage one that no code is specialised for.
TEST_P(Specialised, MovesAndVariesAsAnyLinkageDoes) {
  MechanismCase general = GetParam();
  general.mechanism.springs.push_back({.from_frame = 0, .from = {0.1, 0.2, 0.3}, .to = {5.0, 6.0, 7.0}});
  MovingMechanism special(GetParam(), {}), any(general, {});
  constexpr double kRounding =
      1e-9;  // amplified by the least of the multipliers' pivots, and by thin elements' accelerations
  EXPECT_LE((special.f - any.f).cwiseAbs().maxCoeff(), kRounding * any.f.cwiseAbs().maxCoeff());
  for (MovingMechanism* moving : {&special, &any}) {
    ASSERT_EQ(moving->system.linearise(MovingMechanism::kTime, special.y), EvaluationStatus::kOk);
    ASSERT_TRUE(moving->system.factor(1e4));
  }
  Eigen::VectorXd x = any.f, y = any.f;
  special.system.solve_in_place(x);
  any.system.solve_in_place(y);
  EXPECT_LE((x - y).cwiseAbs().maxCoeff(), kRounding * y.cwiseAbs().maxCoeff());
  EXPECT_LE((special.system.time_derivative() - any.system.time_derivative()).cwiseAbs().maxCoeff(),
            kRounding * any.system.time_derivative().cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(Cases, Specialised, testing::ValuesIn(ideal_linkages()),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Cases, Linearisation, testing::ValuesIn(make_mechanism_cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace engine
