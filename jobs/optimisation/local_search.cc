// SPDX-License-Identifier: Apache-2.0
#include "jobs/optimisation/local_search.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <optional>

#include <nlopt.h>

#include "engine/errors.h"

namespace jobs {
namespace {

/// Fitness of points without a value, and of points beyond bounds, is above this.
constexpr double kMostFitness = 1e99;

struct DestroyNlopt {
  void operator()(nlopt_opt optimiser) const { nlopt_destroy(optimiser); }
};

/// One way of the algorithm from its start.
struct Path {
  const PointSearch::FindFitness& find_fitness;
  nlopt_opt optimiser;
  bool needs_values;  ///< not their order alone
  double worst = 0.0;
  std::size_t known = 0;
  std::optional<UnitPoint> missing{};
  std::exception_ptr error{};

  double evaluate(const UnitPoint& point) {
    if (missing || error) return worst;  // some methods ask on when they are told to stop
    const auto fitness = find_fitness(point);
    if (!fitness) {
      missing = point;
      nlopt_force_stop(optimiser);
      return worst;
    }
    ++known;
    const double value = fitness->front();
    if (needs_values && !(value < kMostFitness)) return worst;  // a model needs values of a like size
    worst = known == 1 ? value : std::max(worst, value);
    return value;
  }
};

/// Called by code in C, through which no exception may pass.
double evaluate_on_path(unsigned n, const double* x, double*, void* data) noexcept {
  auto& path = *static_cast<Path*>(data);
  try {
    return path.evaluate(UnitPoint(x, x + n));
  } catch (...) {
    path.error = std::current_exception();
    nlopt_force_stop(path.optimiser);
    return path.worst;
  }
}

}  // namespace

std::vector<UnitPoint> LocalSearch::ask(const FindFitness& find_fitness) {
  const auto n = static_cast<unsigned>(options_.start.size());
  const bool is_bobyqa = options_.method == LocalMethod::kBobyqa;
  engine::require(n > (is_bobyqa ? 1U : 0U), "start",
                  is_bobyqa ? "of two variables or more" : "of a variable");
  const std::unique_ptr<nlopt_opt_s, DestroyNlopt> optimiser(
      nlopt_create(is_bobyqa ? NLOPT_LN_BOBYQA : NLOPT_LN_NELDERMEAD, n));
  if (!optimiser) throw std::bad_alloc();
  Path path{.find_fitness = find_fitness, .optimiser = optimiser.get(), .needs_values = is_bobyqa};
  nlopt_set_min_objective(optimiser.get(), evaluate_on_path, &path);
  nlopt_set_lower_bounds1(optimiser.get(), 0.0);
  nlopt_set_upper_bounds1(optimiser.get(), 1.0);
  nlopt_set_initial_step1(optimiser.get(), options_.first_step);
  nlopt_set_xtol_abs1(optimiser.get(), options_.step_tolerance);
  nlopt_set_ftol_rel(optimiser.get(), options_.gain_tolerance);
  UnitPoint x = options_.start;
  double least = 0.0;
  const nlopt_result result = nlopt_optimize(optimiser.get(), x.data(), &least);
  if (path.error) std::rethrow_exception(path.error);
  if (result == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
  known_ = path.known;
  if (path.missing) return {*path.missing};
  return {};  // whatever has ended it: rounding errors that leave nothing to gain, too
}

}  // namespace jobs
