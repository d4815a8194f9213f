// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace jobs {

enum class FitBasis { kPointWise, kFeatures };

struct SignalDivergence {
  double ratio = 0.0;  ///< RMS of the difference over the RMS of the signal about its mean
  FitBasis basis = FitBasis::kPointWise;
  std::string message;  ///< meaning of the measure, a sentence
};

/// Ratio above which trajectories of neighbouring starts are no longer one motion.
inline constexpr double kDivergenceThreshold = 0.1;

/// SignalDivergence of trajectories from slightly different starts or parameters: the largest ratio of any of
/// them to the first. Fits compare signals point by point below the threshold, features above it.
/// @param trajectories  two or more, sampled at the same times of the window
[[nodiscard]] SignalDivergence judge_divergence(std::span<const std::vector<double>> trajectories,
                                                double threshold = kDivergenceThreshold);

}  // namespace jobs
