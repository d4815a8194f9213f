// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace jobs {

/// Point of the unit cube.
using UnitPoint = std::vector<double>;

/// Minimisation over the unit cube, with the ask-and-tell interface. The points depend on the options and on
/// the fitness alone: a search that starts anew asks for the same ones.
class PointSearch {
 public:
  /// Fitness of a point, one number an objective; empty: not known yet.
  using FindFitness = std::function<std::optional<std::vector<double>>(const UnitPoint&)>;

  virtual ~PointSearch() = default;
  PointSearch() = default;
  PointSearch(const PointSearch&) = delete;
  PointSearch& operator=(const PointSearch&) = delete;

  /// Points without a fitness that are next. None: the search has converged.
  [[nodiscard]] virtual std::vector<UnitPoint> ask(const FindFitness& find_fitness) = 0;
  /// Generations that are complete; of a local search, points that are known.
  [[nodiscard]] virtual std::size_t generations() const = 0;
};

}  // namespace jobs
