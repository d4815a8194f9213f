// SPDX-License-Identifier: Apache-2.0
#include "jobs/optimisation/local_search.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <nlopt.h>

#include "engine/errors.h"
#include "jobs/statistics/unit_points.h"

namespace jobs {
namespace {

/// Fitness of points without a value is above this.
constexpr double kMostFitness = 1e199;
/// Other starts, where the start has no value.
constexpr std::size_t kMostStarts = 32;
constexpr int kMostEvaluations = 100'000;  // far more than the tolerances let a method ask for

struct DestroyNlopt {
  void operator()(nlopt_opt optimiser) const { nlopt_destroy(optimiser); }
};
using NloptPointer = std::unique_ptr<nlopt_opt_s, DestroyNlopt>;

void check_dimensions(const LocalOptions& options) {
  const bool is_bobyqa = options.method == LocalMethod::kBobyqa;
  engine::require(options.start.size() > (is_bobyqa ? 1U : 0U), "start",
                  is_bobyqa ? "of two variables or more" : "of a variable");
}

/// The first start that has a value, or whose value is not known yet; empty: none has one.
std::optional<UnitPoint> find_valid_start(const LocalOptions& options,
                                          const PointSearch::FindFitness& find_fitness) {
  std::vector<UnitPoint> starts{options.start};
  for (UnitPoint& point : sobol_points(kMostStarts, options.start.size(), options.seed))
    starts.push_back(std::move(point));
  const auto has_no_value = [&](const UnitPoint& point) {
    const auto fitness = find_fitness(point);
    return fitness && !(fitness->front() < kMostFitness);
  };
  const auto start = std::ranges::find_if_not(starts, has_no_value);
  return start == starts.end() ? std::nullopt : std::optional(*start);
}

/// Optimiser without an objective.
NloptPointer make_optimiser(const LocalOptions& options) {
  const auto n = static_cast<unsigned>(options.start.size());
  const bool is_bobyqa = options.method == LocalMethod::kBobyqa;
  NloptPointer optimiser(nlopt_create(is_bobyqa ? NLOPT_LN_BOBYQA : NLOPT_LN_NELDERMEAD, n));
  if (!optimiser) throw std::bad_alloc();
  nlopt_set_lower_bounds1(optimiser.get(), 0.0);
  nlopt_set_upper_bounds1(optimiser.get(), 1.0);
  nlopt_set_initial_step1(optimiser.get(), options.first_step);
  nlopt_set_xtol_abs1(optimiser.get(), options.step_tolerance);
  nlopt_set_ftol_rel(optimiser.get(), options.gain_tolerance);
  nlopt_set_maxeval(optimiser.get(), kMostEvaluations);
  return optimiser;
}

/// One way of the algorithm from its start.
struct Path {
  const PointSearch::FindFitness& find_fitness;
  nlopt_opt optimiser;
  bool needs_values;  ///< not their order alone
  double worst;       ///< of the values so far, the start's among them
  std::set<UnitPoint> known{};
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
    const double value = fitness->front();
    known.insert(point);
    if (needs_values && !(value < kMostFitness)) return worst;  // a model needs values of a like size
    worst = std::max(worst, value);
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

/// Runs an optimiser from a start. @throws what the evaluation of a point has thrown
void run_search(Path& path, UnitPoint start) {
  nlopt_set_min_objective(path.optimiser, evaluate_on_path, &path);
  double least = 0.0;
  const nlopt_result result = nlopt_optimize(path.optimiser, start.data(), &least);
  if (path.error) std::rethrow_exception(path.error);
  if (result == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
  if (result == NLOPT_INVALID_ARGS) throw std::logic_error("NLopt takes no such search");
}

}  // namespace

std::vector<UnitPoint> LocalSearch::ask(const FindFitness& find_fitness) {
  check_dimensions(options_);
  const auto start = find_valid_start(options_, find_fitness);
  if (!start) return {};
  const auto start_fitness = find_fitness(*start);
  if (!start_fitness) return {*start};
  const NloptPointer optimiser = make_optimiser(options_);
  Path path{.find_fitness = find_fitness,
            .optimiser = optimiser.get(),
            .needs_values = options_.method == LocalMethod::kBobyqa,
            .worst = start_fitness->front()};
  run_search(path, *start);
  known_ = path.known.size();
  if (path.missing) return {*path.missing};
  return {};  // whatever has ended it: rounding errors that leave nothing to gain, too
}

}  // namespace jobs
