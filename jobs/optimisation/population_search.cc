// SPDX-License-Identifier: Apache-2.0
#include "jobs/optimisation/population_search.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/types.hpp>
#include <pagmo/utils/multi_objective.hpp>

namespace jobs {
namespace {

/// Evaluations of one generation. The algorithms of pagmo make all points of a generation before they look at
/// the fitness of one, so that unknown points can be gathered in one call.
struct Generation {
  const PopulationSearch::FindFitness* find_fitness = nullptr;
  std::size_t evaluated = 0;
  std::vector<UnitPoint> missing{};
};

/// Problem as pagmo wants it.
class UnitProblem {
 public:
  UnitProblem() = default;  // pagmo asks for one
  UnitProblem(std::size_t dimensions, std::size_t objectives, Generation* generation)
      : dimensions_(dimensions), objectives_(objectives), generation_(generation) {}

  [[nodiscard]] pagmo::vector_double fitness(const pagmo::vector_double& point) const {
    ++generation_->evaluated;
    if (auto known = (*generation_->find_fitness)(point)) return *known;
    generation_->missing.push_back(point);
    return pagmo::vector_double(objectives_, 0.0);
  }
  [[nodiscard]] std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(dimensions_, 0.0), pagmo::vector_double(dimensions_, 1.0)};
  }
  [[nodiscard]] pagmo::vector_double::size_type get_nobj() const { return objectives_; }

 private:
  std::size_t dimensions_ = 1;
  std::size_t objectives_ = 1;
  Generation* generation_ = nullptr;
};

using Algorithm = std::variant<pagmo::cmaes, pagmo::nsga2>;

Algorithm make_algorithm(const PopulationOptions& options) {
  constexpr double kDefault = -1.0;     // pagmo's own choice
  constexpr double kInitialStep = 0.3;  // of the unit cube, as Hansen advises
  constexpr double kNever = 0.0;        // has_converged() judges
  if (options.method == PopulationMethod::kCmaEs) {
    constexpr double kSmallestStep = 1e-9;
    return pagmo::cmaes(1, kDefault, kDefault, kDefault, kDefault, kInitialStep, kNever, kSmallestStep, true,
                        true, options.seed);
  }
  const double mutation = 1.0 / static_cast<double>(options.dimensions);
  return pagmo::nsga2(1, 0.95, 10.0, mutation, 20.0, options.seed);  // pagmo's own
}

/// Progress of a population.
struct Summary {
  std::vector<double> values;  ///< least one and mean of the first front, for each objective
  std::vector<double> scales;  ///< by which their changes are judged
};

std::vector<pagmo::pop_size_t> first_front_of(const pagmo::population& population) {
  if (population.get_f().front().size() == 1) return {population.best_idx()};
  return std::get<0>(pagmo::fast_non_dominated_sorting(population.get_f())).front();
}

/// @param values  of an objective, of the first front
void add_objective(const std::vector<double>& values, Summary& summary) {
  double least = values.front();
  double most = least;
  double sum = 0.0;
  for (const double value : values) {
    least = std::min(least, value);
    most = std::max(most, value);
    sum += value;
  }
  const double scale = std::max(std::abs(least), most - least);
  summary.values.insert(summary.values.end(), {least, sum / static_cast<double>(values.size())});
  summary.scales.insert(summary.scales.end(), {scale, scale});
}

Summary summarise(const pagmo::population& population) {
  const auto& fitness = population.get_f();
  const std::vector<pagmo::pop_size_t> front = first_front_of(population);
  Summary summary;
  for (std::size_t k = 0; k < fitness.front().size(); ++k) {
    std::vector<double> values;
    for (const auto member : front) values.push_back(fitness[member][k]);
    add_objective(values, summary);
  }
  return summary;
}

}  // namespace

std::size_t default_population(PopulationMethod method, std::size_t dimensions) {
  if (method == PopulationMethod::kNsga2) return 40;
  // Hansen's 4 + 3 ln n, even since two are computed at a time.
  const auto usual = static_cast<std::size_t>(4.0 + 3.0 * std::log(static_cast<double>(dimensions)));
  return std::max<std::size_t>(6, usual + usual % 2);
}

class PopulationSearch::State {
 public:
  explicit State(const PopulationOptions& options) : options_(options), algorithm_(make_algorithm(options)) {}

  std::vector<UnitPoint> ask(const FindFitness& find_fitness) {
    generation_.find_fitness = &find_fitness;
    while (!converged_) {
      generation_.evaluated = 0;
      generation_.missing.clear();
      Algorithm algorithm = algorithm_;  // an incomplete generation is made again from the same state
      pagmo::population next = population_ ? evolve(algorithm) : make_population();
      if (!generation_.missing.empty()) return generation_.missing;
      algorithm_ = std::move(algorithm);
      end_generation(std::move(next));
    }
    return {};
  }

  [[nodiscard]] std::size_t generations() const { return generations_; }

 private:
  pagmo::population evolve(const Algorithm& algorithm) {
    return std::visit([&](const auto& chosen) { return chosen.evolve(*population_); }, algorithm);
  }

  pagmo::population make_population() {
    pagmo::population made(
        pagmo::problem(UnitProblem(options_.dimensions, options_.objectives, &generation_)),
        options_.start ? options_.population - 1 : options_.population, options_.seed);
    if (options_.start) made.push_back(*options_.start);
    return made;
  }

  void end_generation(pagmo::population next) {
    if (population_) ++generations_;
    converged_ = generation_.evaluated == 0;
    population_ = std::move(next);
    history_.push_back(summarise(*population_));
    if (options_.objectives == 1 && history_.size() > 1) keep_best();
    converged_ = converged_ || has_converged();
  }

  /// A generation of CMA-ES may be worse than the one before: the best so far counts.
  void keep_best() {
    const Summary& before = history_[history_.size() - 2];
    if (before.values.front() < history_.back().values.front()) history_.back() = before;
  }

  /// @returns whether the last generations have gained too little: as many as Hansen's criterion of equal
  /// function values takes
  [[nodiscard]] bool has_converged() const {
    const auto patience =
        static_cast<std::size_t>(10.0 + std::ceil(30.0 * static_cast<double>(options_.dimensions) /
                                                  static_cast<double>(options_.population)));
    if (history_.size() <= patience) return false;
    const Summary& before = history_[history_.size() - 1 - patience];
    const Summary& now = history_.back();
    for (std::size_t k = 0; k < now.values.size(); ++k) {
      if (std::abs(before.values[k] - now.values[k]) > options_.tolerance * now.scales[k]) return false;
    }
    return true;
  }

  const PopulationOptions options_;
  Generation generation_;
  Algorithm algorithm_;
  std::optional<pagmo::population> population_;  ///< the last complete one
  std::size_t generations_ = 0;
  std::vector<Summary> history_;  ///< of all complete generations
  bool converged_ = false;
};

PopulationSearch::PopulationSearch(const PopulationOptions& options)
    : state_(std::make_unique<State>(options)) {}
PopulationSearch::~PopulationSearch() = default;

std::vector<UnitPoint> PopulationSearch::ask(const FindFitness& find_fitness) {
  return state_->ask(find_fitness);
}

std::size_t PopulationSearch::generations() const { return state_->generations(); }

}  // namespace jobs
