// SPDX-License-Identifier: Apache-2.0
// Functions whose minima are known, and searches for them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "jobs/optimisation/point_search.h"

namespace jobs_tests {

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
inline Solved run_search(jobs::PointSearch& search, const Function& function, std::size_t most,
                    const Known& known = {}) {
  Solved solved{.known = known};
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

inline double least_of(const Solved& solved) {
  double least = INFINITY;
  for (const auto& [point, values] : solved.known) least = std::min(least, values.front());
  return least;
}

inline std::vector<double> rosenbrock_valley(const UnitPoint& point) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < point.size(); ++i) {
    const double x = 4.0 * point[i] - 2.0;
    const double y = 4.0 * point[i + 1] - 2.0;
    sum += 100.0 * std::pow(y - x * x, 2) + std::pow(1.0 - x, 2);
  }
  return {sum};
}

/// Three equal minima of 0.397887 (F. H. Branin, IBM J. Res. Dev. 16 (1972) 504).
inline std::vector<double> branin(const UnitPoint& point) {
  constexpr double kPi = std::numbers::pi;
  const double x = 15.0 * point[0] - 5.0;
  const double y = 15.0 * point[1];
  const double bowl = y - 5.1 / (4.0 * kPi * kPi) * x * x + 5.0 / kPi * x - 6.0;
  return {bowl * bowl + 10.0 * (1.0 - 1.0 / (8.0 * kPi)) * std::cos(x) + 10.0};
}

/// E. Zitzler, K. Deb and L. Thiele, Evol. Comput. 8 (2000) 173: the front is f2 = 1 - sqrt(f1).
inline std::vector<double> zdt1(const UnitPoint& point) {
  double sum = 0.0;
  for (std::size_t i = 1; i < point.size(); ++i) sum += point[i];
  const double g = 1.0 + 9.0 * sum / static_cast<double>(point.size() - 1);
  return {point[0], g * (1.0 - std::sqrt(point[0] / g))};
}

}  // namespace jobs_tests
