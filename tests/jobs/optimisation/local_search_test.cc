// SPDX-License-Identifier: Apache-2.0
// Local searches on functions whose minima are known.

#include "jobs/optimisation/local_search.h"

#include <cmath>
#include <cstddef>
#include <new>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/errors.h"
#include "tests/jobs/optimisation/search_problems.h"

namespace jobs_tests {
namespace {

using jobs::LocalMethod;
using jobs::LocalOptions;
using jobs::LocalSearch;

Solved solve(const LocalOptions& options, const Function& function, std::size_t most,
             const Known& known = {}) {
  LocalSearch search(options);
  return run_search(search, function, most, known);
}

TEST(LocalSearch, FindsTheEndOfRosenbrocksValley) {
  for (const LocalMethod method : {LocalMethod::kNelderMead, LocalMethod::kBobyqa}) {
    const Solved solved =
        solve({.method = method, .start = {0.2, 0.7}, .step_tolerance = 1e-7, .gain_tolerance = 0.0},
              rosenbrock_valley, 1000);
    EXPECT_LT(least_of(solved), 1e-9);
    EXPECT_TRUE(solved.converged);
    EXPECT_EQ(solved.repeated, 0U);
    EXPECT_LT(solved.known.size(), 300U);
  }
}

TEST(LocalSearch, FindsAMinimumOfBraninsFunctionInFewPoints) {
  const Solved models = solve({.method = LocalMethod::kBobyqa, .start = {0.5, 0.5}}, branin, 1000);
  EXPECT_NEAR(least_of(models), 0.397887, 1e-4);
  EXPECT_LT(models.known.size(), 60U);
  const Solved simplices = solve({.method = LocalMethod::kNelderMead, .start = {0.5, 0.5}}, branin, 1000);
  EXPECT_NEAR(least_of(simplices), 0.397887, 1e-3);
  EXPECT_LT(simplices.known.size(), 120U);
}

// The corner is the least of a plane: the searches stay within the cube.
TEST(LocalSearch, EndsInACorner) {
  const Function plane = [](const UnitPoint& point) {
    return std::vector<double>{1.0 + point[0] - 2.0 * point[1]};
  };
  for (const LocalMethod method : {LocalMethod::kNelderMead, LocalMethod::kBobyqa}) {
    const Solved solved = solve({.method = method, .start = {0.5, 0.5}}, plane, 500);
    EXPECT_NEAR(least_of(solved), -1.0, 1e-3);
    EXPECT_TRUE(solved.converged);
    for (const auto& [point, value] : solved.known)
      for (const double x : point) EXPECT_TRUE(x >= 0.0 && x <= 1.0) << x;
  }
}

TEST(LocalSearch, TakesOneVariableWithSimplicesOnly) {
  const Function parabola = [](const UnitPoint& point) {
    return std::vector<double>{1.0 + std::pow(point[0] - 0.3, 2)};
  };
  EXPECT_NEAR(least_of(solve({.start = {0.9}, .gain_tolerance = 1e-7}, parabola, 200)), 1.0, 1e-5);
  EXPECT_THROW(solve({.method = LocalMethod::kBobyqa, .start = {0.9}}, parabola, 200), engine::InvalidInput);
}

// Where half of the square has no value, the least of the other half is found.
TEST(LocalSearch, GoesAroundWhatHasNoValue) {
  const Function half = [](const UnitPoint& point) -> std::vector<double> {
    if (point[0] > 0.6) return {1e200};
    return {1.0 + std::pow(point[0] - 0.4, 2) + std::pow(point[1] - 0.3, 2)};
  };
  for (const LocalMethod method : {LocalMethod::kNelderMead, LocalMethod::kBobyqa}) {
    const Solved solved = solve({.method = method, .start = {0.55, 0.8}}, half, 500);
    EXPECT_NEAR(least_of(solved), 1.0, 1e-3);
    EXPECT_TRUE(solved.converged);
  }
}

TEST(LocalSearch, BeginsElsewhereIfTheStartHasNoValue) {
  const Function half = [](const UnitPoint& point) -> std::vector<double> {
    if (point[0] > 0.6) return {1e200};
    return {5.0 + std::pow(point[0] - 0.4, 2) + std::pow(point[1] - 0.3, 2)};
  };
  for (const LocalMethod method : {LocalMethod::kNelderMead, LocalMethod::kBobyqa}) {
    const Solved solved = solve({.method = method, .start = {0.9, 0.8}}, half, 500);
    EXPECT_NEAR(least_of(solved), 5.0, 5e-3);
    EXPECT_TRUE(solved.converged);
  }
}

TEST(LocalSearch, EndsWhereNothingHasAValue) {
  for (const LocalMethod method : {LocalMethod::kNelderMead, LocalMethod::kBobyqa}) {
    const Solved solved = solve(
        {.method = method, .start = {0.5, 0.5}}, [](const UnitPoint&) { return std::vector<double>{1e200}; },
        1000);
    EXPECT_TRUE(solved.converged);
    EXPECT_LT(solved.known.size(), 200U);
  }
}

TEST(LocalSearch, AsksAnewForNothingThatIsKnown) {
  for (const LocalMethod method : {LocalMethod::kNelderMead, LocalMethod::kBobyqa}) {
    const LocalOptions options{.method = method, .start = {0.2, 0.7}};
    const Solved whole = solve(options, rosenbrock_valley, 60);
    const Solved half = solve(options, rosenbrock_valley, 30);
    const Solved rest = solve(options, rosenbrock_valley, 60, half.known);
    EXPECT_EQ(rest.known, whole.known);
    EXPECT_EQ(rest.repeated, 0U);
  }
}

TEST(LocalSearch, PassesOnWhatTheFitnessThrows) {
  LocalSearch search({.start = {0.5, 0.5}});
  EXPECT_THROW((void)search.ask(
                   [](const UnitPoint&) -> std::optional<std::vector<double>> { throw std::bad_alloc(); }),
               std::bad_alloc);
}

}  // namespace
}  // namespace jobs_tests
