// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "jobs/optimisation/point_search.h"

namespace jobs {

/// Method of a population search: the covariance matrix adaptation evolution strategy for one objective
/// (N. Hansen, arXiv:1604.00772), the elitist non-dominated sorting genetic algorithm for several (K. Deb et
/// al., IEEE Trans. Evol. Comput. 6 (2002) 182).
enum class PopulationMethod { kCmaEs, kNsga2 };

struct PopulationOptions {
  PopulationMethod method = PopulationMethod::kCmaEs;
  std::size_t dimensions = 1;
  std::size_t objectives = 1;
  std::size_t population = 8;  ///< individuals of a generation, >= 5; kNsga2: a multiple of 4, >= 8
  unsigned seed = 1;
  double tolerance = 1e-3;           ///< relative gain below which a search has converged
  std::optional<UnitPoint> start{};  ///< an individual of the first generation; empty: all are random
};

/// Individuals of a generation that suit a method. @param dimensions  >= 1
[[nodiscard]] std::size_t default_population(PopulationMethod method, std::size_t dimensions);

/// Minimisation over the unit cube with pagmo's evolutionary algorithms, for which only the order of fitness
/// counts. Each generation is asked for as a whole, so that its points can be evaluated at the same time.
class PopulationSearch final : public PointSearch {
 public:
  explicit PopulationSearch(const PopulationOptions& options);
  ~PopulationSearch() override;

  [[nodiscard]] std::vector<UnitPoint> ask(const FindFitness& find_fitness) override;
  [[nodiscard]] std::size_t generations() const override;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace jobs
