// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_observer.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/store/store.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

/// Noise of deviation 1 that is measured, and compared with a model that gives zero.
jobs::FitProblem noise_problem(std::size_t samples, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  jobs::FitProblem problem;
  jobs::FitSignal& signal = problem.signals.emplace_back();
  for (std::size_t k = 0; k < samples; ++k) {
    signal.compared.t.push_back(1e-3 * static_cast<double>(k));
    signal.compared.y.push_back(normal(generator));
  }
  signal.measured.sigma = 1.0;
  signal.noise = jobs::estimate_noise(signal.compared.t, signal.compared.y);
  signal.noise_samples = samples;
  return problem;
}

// The bound is that of one in twenty: 20 of 400 draws, which scatter by 4.4. The formula takes the true noise,
// where only the estimated one is known, so that somewhat more exceed it.
TEST(FitObserver, TakesEstimatedNoiseForNoise) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  for (const std::size_t samples : {600U, 4000U}) {
    int exceeding = 0;
    for (std::uint32_t seed = 1; seed <= 400; ++seed) {
      const auto problem = std::make_shared<jobs::FitProblem>(noise_problem(samples, seed));
      const jobs::FitObserver observer(problem, store.reader);
      if (observer.misfit(problem->signals[0].compared.y) > observer.misfit_of_noise()) ++exceeding;
    }
    EXPECT_GT(exceeding, 5) << samples;
    EXPECT_LT(exceeding, 40) << samples;
  }
}

TEST(FitObserver, TakesTwiceTheNoiseForMore) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const auto problem = std::make_shared<jobs::FitProblem>(noise_problem(600, 1));
  std::vector<double> residuals = problem->signals[0].compared.y;
  for (double& residual : residuals) residual *= 2.0;
  const jobs::FitObserver observer(problem, store.reader);
  EXPECT_GT(observer.misfit(residuals), observer.misfit_of_noise());
}

}  // namespace
}  // namespace jobs_tests
