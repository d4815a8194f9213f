// SPDX-License-Identifier: Apache-2.0
// Population searches on functions whose minima are known.

#include "jobs/optimisation/population_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/statistics/splitmix64.h"
#include "tests/jobs/optimisation/search_problems.h"

namespace jobs_tests {
namespace {

using jobs::PopulationMethod;
using jobs::PopulationOptions;
using jobs::PopulationSearch;

Solved solve(const PopulationOptions& options, const Function& function, std::size_t most,
             const Known& known = {}) {
  PopulationSearch search(options);
  return run_search(search, function, most, known);
}

TEST(PopulationSearch, FindsTheEndOfRosenbrocksValley) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Solved solved =
        solve({.dimensions = 3, .population = 8, .seed = seed, .tolerance = 1e-6}, rosenbrock_valley, 5000);
    EXPECT_LT(least_of(solved), 1e-9) << "seed " << seed;
    EXPECT_TRUE(solved.converged) << "seed " << seed;
    EXPECT_EQ(solved.repeated, 0U) << "seed " << seed;
  }
}

TEST(PopulationSearch, FindsAMinimumOfBraninsFunction) {
  const Solved solved = solve({.dimensions = 2, .population = 6, .seed = 1}, branin, 2000);
  EXPECT_NEAR(least_of(solved), 0.397887, 1e-4);
  EXPECT_TRUE(solved.converged);
}

TEST(PopulationSearch, FindsTheFrontOfZdt1) {
  const Solved solved = solve(
      {.method = PopulationMethod::kNsga2, .dimensions = 5, .objectives = 2, .population = 40, .seed = 1},
      zdt1, 8000);
  // Each tenth of the front has a point near it.
  for (double f1 = 0.05; f1 < 1.0; f1 += 0.1) {
    double off = INFINITY;
    for (const auto& [point, values] : solved.known)
      off = std::min(off, std::hypot(values[0] - f1, values[1] - (1.0 - std::sqrt(f1))));
    EXPECT_LT(off, 0.05) << "f1 = " << f1;
  }
}

TEST(PopulationSearch, IsNotLedAstrayByNoise) {
  std::uint64_t draws = 0;
  const Function noisy_quadratic = [&](const UnitPoint& point) -> std::vector<double> {
    double sum = 0.0;
    for (const double x : point) sum += std::pow(x - 0.3, 2);
    const double noise = static_cast<double>(jobs::splitmix64(7, draws++) >> 11U) * 0x1p-53 - 0.5;
    return {1.0 + sum + 0.02 * noise};
  };
  const Solved solved = solve({.dimensions = 3, .population = 12, .seed = 1}, noisy_quadratic, 2000);
  const auto best =
      std::ranges::min_element(solved.known, {}, [](const auto& point) { return point.second.front(); });
  for (const double x : best->first) EXPECT_NEAR(x, 0.3, 0.15);
}

TEST(PopulationSearch, AsksAnewForNothingThatIsKnown) {
  for (const PopulationMethod method : {PopulationMethod::kCmaEs, PopulationMethod::kNsga2}) {
    const bool single = method == PopulationMethod::kCmaEs;
    const PopulationOptions options{
        .method = method, .dimensions = 3, .objectives = single ? 1U : 2U, .population = 8, .seed = 4};
    const Function function = single ? Function(rosenbrock_valley) : Function(zdt1);
    const Solved whole = solve(options, function, 400);
    // Half of it, and the rest by another search that knows these.
    const Solved half = solve(options, function, 200);
    const Solved rest = solve(options, function, 400, half.known);
    EXPECT_EQ(rest.known, whole.known);
    EXPECT_EQ(rest.repeated, 0U);
  }
}

TEST(PopulationSearch, BeginsWithTheStart) {
  PopulationSearch search({.dimensions = 2, .population = 6, .seed = 1, .start = UnitPoint{0.25, 0.75}});
  const auto first = search.ask([](const UnitPoint&) { return std::nullopt; });
  EXPECT_EQ(first.size(), 6U);
  EXPECT_NE(std::ranges::find(first, UnitPoint{0.25, 0.75}), first.end());
}

TEST(PopulationSearch, EndsWhereNothingIsBetter) {
  const Solved solved = solve(
      {.dimensions = 2, .population = 6, .seed = 1},
      [](const UnitPoint&) { return std::vector<double>{1e200}; }, 5000);
  EXPECT_TRUE(solved.converged);
  EXPECT_LT(solved.known.size(), 500U);
}

}  // namespace
}  // namespace jobs_tests
