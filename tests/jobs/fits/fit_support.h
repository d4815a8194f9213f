// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/fits/evaluations.h"
#include "jobs/fits/least_squares.h"
#include "jobs/fits/profile_likelihood.h"

namespace jobs_tests {

using Residuals = std::function<std::vector<double>(const jobs::FitPoint&)>;

/// Asks and tells until there is a result. Fails if a point is asked for twice. Empty residuals: failed.
template <typename Asker>
auto run_asker(Asker& asker, const Residuals& residuals,
               std::map<jobs::FitPoint, std::vector<double>>* told = nullptr) {
  std::map<jobs::FitPoint, std::vector<double>> own;
  auto& seen = told == nullptr ? own : *told;
  for (int round = 0; round < 1000; ++round) {
    auto answer = asker.ask();
    if (answer.result) return *answer.result;
    for (const jobs::FitPoint& point : answer.points) {
      const auto [at, fresh] = seen.try_emplace(point, residuals(point));
      EXPECT_TRUE(fresh) << "asked twice";
      if (at->second.empty()) asker.tell_failed(point);
      else asker.tell(point, at->second);
    }
  }
  ADD_FAILURE() << "no end";
  return *decltype(asker.ask().result){std::in_place};
}

/// A problem with its evaluations, which are told one by one.
template <typename Problem, auto kSolve>
class Asker {
 public:
  explicit Asker(Problem problem) : problem_(std::move(problem)) {}

  [[nodiscard]] auto ask() const { return kSolve(problem_, evaluations_); }
  void tell(const jobs::FitPoint& point, std::vector<double> residuals) {
    evaluations_.tell(point, std::move(residuals));
  }
  void tell_failed(const jobs::FitPoint& point) { evaluations_.tell_failed(point); }

 private:
  Problem problem_;
  jobs::Evaluations evaluations_;
};
using LeastSquares = Asker<jobs::LeastSquaresProblem, jobs::solve_least_squares>;
using ProfileLikelihood = Asker<jobs::ProfileProblem, jobs::profile_likelihood>;

inline std::vector<double> rosenbrock(const jobs::FitPoint& x) {
  return {10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]};
}

inline jobs::LeastSquaresProblem rosenbrock_problem() {
  jobs::LeastSquaresProblem problem;
  problem.spans = {{-3.0, 3.0, false}, {-3.0, 3.0, false}};
  problem.start = {-1.2, 1.0};
  return problem;
}

/// Damped oscillation x0 exp(-x1 t) cos(x2 t), 0.02 s apart.
inline std::vector<double> oscillation(const jobs::FitPoint& x, std::size_t n) {
  std::vector<double> y;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = 0.02 * static_cast<double>(k);
    y.push_back(x[0] * std::exp(-x[1] * t) * std::cos(x[2] * t));
  }
  return y;
}

/// Autoregressive noise of order 1 with unit variance.
inline std::vector<double> make_noise(std::size_t n, double correlation, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> noise{normal(random)};
  while (noise.size() < n)
    noise.push_back(correlation * noise.back() + std::sqrt(1.0 - correlation * correlation) * normal(random));
  return noise;
}

}  // namespace jobs_tests
