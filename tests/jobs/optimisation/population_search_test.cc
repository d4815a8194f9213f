// SPDX-License-Identifier: Apache-2.0
// Population searches on functions whose minima are known.

#include "jobs/optimisation/population_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/statistics/splitmix64.h"

namespace jobs_tests {
namespace {

using jobs::PopulationMethod;
using jobs::PopulationOptions;
using jobs::PopulationSearch;
using jobs::UnitPoint;

using Function = std::function<std::vector<double>(const UnitPoint&)>;
using Known = std::map<UnitPoint, std::vector<double>>;

/// Outcome of a search.
struct Solved {
  Known known;               ///< all points that it asked for
  std::size_t repeated = 0;  ///< points that it asked for although they were known
  bool converged = false;
};

/// @param most  points that are computed
Solved solve(const PopulationOptions& options, const Function& function, std::size_t most,
             const Known& known = {}) {
  Solved solved{.known = known};
  PopulationSearch search(options);
  while (solved.known.size() < most) {
    const auto points = search.ask([&](const UnitPoint& point) -> std::optional<std::vector<double>> {
      const auto found = solved.known.find(point);
      return found == solved.known.end() ? std::nullopt : std::optional(found->second);
    });
    if (points.empty()) {
      solved.converged = true;
      return solved;
    }
    for (const UnitPoint& point : points)
      if (!solved.known.emplace(point, function(point)).second) ++solved.repeated;
  }
  return solved;
}

double least_of(const Solved& solved) {
  double least = INFINITY;
  for (const auto& [point, values] : solved.known) least = std::min(least, values.front());
  return least;
}

std::vector<double> rosenbrock(const UnitPoint& point) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < point.size(); ++i) {
    const double x = 4.0 * point[i] - 2.0;
    const double y = 4.0 * point[i + 1] - 2.0;
    sum += 100.0 * std::pow(y - x * x, 2) + std::pow(1.0 - x, 2);
  }
  return {sum};
}

/// Three equal minima of 0.397887 (F. H. Branin, IBM J. Res. Dev. 16 (1972) 504).
std::vector<double> branin(const UnitPoint& point) {
  constexpr double kPi = std::numbers::pi;
  const double x = 15.0 * point[0] - 5.0;
  const double y = 15.0 * point[1];
  const double bowl = y - 5.1 / (4.0 * kPi * kPi) * x * x + 5.0 / kPi * x - 6.0;
  return {bowl * bowl + 10.0 * (1.0 - 1.0 / (8.0 * kPi)) * std::cos(x) + 10.0};
}

/// E. Zitzler, K. Deb and L. Thiele, Evol. Comput. 8 (2000) 173: the front is f2 = 1 - sqrt(f1).
std::vector<double> zdt1(const UnitPoint& point) {
  double sum = 0.0;
  for (std::size_t i = 1; i < point.size(); ++i) sum += point[i];
  const double g = 1.0 + 9.0 * sum / static_cast<double>(point.size() - 1);
  return {point[0], g * (1.0 - std::sqrt(point[0] / g))};
}

TEST(PopulationSearch, FindsTheEndOfRosenbrocksValley) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Solved solved =
        solve({.dimensions = 3, .population = 8, .seed = seed, .tolerance = 1e-6}, rosenbrock, 5000);
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
    const Function function = single ? Function(rosenbrock) : Function(zdt1);
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
