// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/divergence.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "engine/errors.h"

namespace jobs {
namespace {

/// Sum of the squares of the deviations from the mean.
double sum_deviations(const std::vector<double>& y) {
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
  return std::accumulate(y.begin(), y.end(), 0.0,
                         [mean](double sum, double value) { return sum + (value - mean) * (value - mean); });
}

/// The largest sum of squared differences from the first trajectory.
double find_largest_difference(std::span<const std::vector<double>> trajectories) {
  const std::vector<double>& first = trajectories[0];
  double largest = 0.0;
  for (const auto& other : trajectories.subspan(1)) {
    engine::require(other.size() == first.size(), "trajectories", "sampled at the same times");
    double squares = 0.0;
    for (std::size_t k = 0; k < first.size(); ++k) squares += (other[k] - first[k]) * (other[k] - first[k]);
    largest = std::max(largest, squares);
  }
  return largest;
}

std::string percent(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100.0 * ratio);
  return text;
}

std::string describe_divergence(const SignalDivergence& divergence, double threshold) {
  const bool diverges = divergence.basis == FitBasis::kFeatures;
  return "Trajectories from slightly different starts differ by " + percent(divergence.ratio) +
         " of the signal" +
         (diverges ? ", more than " + percent(threshold) + ": the fit compares features of the signals."
                   : ": the fit compares the signals point by point.");
}

}  // namespace

SignalDivergence judge_divergence(std::span<const std::vector<double>> trajectories, double threshold) {
  engine::require(trajectories.size() >= 2 && !trajectories[0].empty(), "trajectories",
                  "two or more, not empty");
  const double largest = find_largest_difference(trajectories);
  const double signal = sum_deviations(trajectories[0]);
  SignalDivergence divergence;
  if (largest > 0.0)
    divergence.ratio = signal > 0.0 ? std::sqrt(largest / signal) : std::numeric_limits<double>::infinity();
  const bool diverges = !(divergence.ratio <= threshold);
  divergence.basis = diverges ? FitBasis::kFeatures : FitBasis::kPointWise;
  divergence.message = describe_divergence(divergence, threshold);
  return divergence;
}

}  // namespace jobs
