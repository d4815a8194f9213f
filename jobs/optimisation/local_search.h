// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "jobs/optimisation/point_search.h"

namespace jobs {

/// Method of a local search. kNelderMead: simplices (J. A. Nelder and R. Mead, Comput. J. 7 (1965) 308), for
/// which the order of fitness counts. kBobyqa: quadratic models (M. J. D. Powell, DAMTP 2009/NA06), for
/// smooth fitness of two variables or more.
enum class LocalMethod { kNelderMead, kBobyqa };

struct LocalOptions {
  LocalMethod method = LocalMethod::kNelderMead;
  UnitPoint start;               ///< without a value: the first of Sobol's points that has one
  std::uint64_t seed = 1;        ///< of those
  double first_step = 0.2;       ///< of the unit cube
  double step_tolerance = 1e-4;  ///< steps below which a search has converged
  double gain_tolerance = 1e-4;  ///< the same of the fitness, relative
};

/// Minimisation of one objective over the unit cube from a start, with NLopt's algorithms. They make one
/// point after the other; each ask() follows them from the start over the known points, which costs no job.
class LocalSearch final : public PointSearch {
 public:
  explicit LocalSearch(LocalOptions options) : options_(std::move(options)) {}

  [[nodiscard]] std::vector<UnitPoint> ask(const FindFitness& find_fitness) override;
  [[nodiscard]] std::size_t generations() const override { return known_; }

 private:
  LocalOptions options_;
  std::size_t known_ = 0;
};

}  // namespace jobs
