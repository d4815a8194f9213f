// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/fits/divergence.h"
#include "jobs/fits/fit_observer.h"
#include "jobs/fits/intervals.h"
#include "jobs/fits/profile_likelihood.h"
#include "jobs/parameters/unit_scale.h"

namespace jobs {

/// Stage of a fit. kDesign: points that fill the space (Sobol). kDivergence: points beside good ones, by
/// which the basis is chosen. kScatter: more of them, whose features give the scale of features. kGlobal:
/// population search. kLocal: least squares. kScan: each parameter over its span, the others as in the best
/// point. kProfile: profile likelihood. kPrediction: runs that are held back, with the best values.
enum class FitStage { kDesign, kDivergence, kScatter, kGlobal, kLocal, kScan, kProfile, kPrediction, kEnded };

[[nodiscard]] constexpr std::string_view stage_name(FitStage stage) {
  constexpr std::array<std::string_view, 9> kNames{"design", "divergence", "scatter",    "global", "local",
                                                   "scan",   "profile",    "prediction", "ended"};
  return kNames[static_cast<std::size_t>(stage)];
}

enum class FitPointState { kPending, kSucceeded, kLost };

[[nodiscard]] constexpr std::string_view state_name(FitPointState state) {
  constexpr std::array<std::string_view, 3> kNames{"pending", "succeeded", "lost"};
  return kNames[static_cast<std::size_t>(state)];
}

/// Point that a fit has asked for.
struct FitPointSummary {
  FitPoint point;
  FitStage stage = FitStage::kDesign;
  FitPointState state = FitPointState::kPending;
  std::optional<double> sum{};       ///< of the squares of residuals; of samples until the basis is known
  double loss = 0.0;                 ///< by which points are compared, if there is a sum
  std::vector<double> deviations{};  ///< FitObserver::calc_deviations(), of samples
  std::optional<std::string> lost_reason{};  ///< as OptimisationCandidate has it
  std::vector<std::string> job_ids{};        ///< one a run; empty where there is no job
};

/// Least and largest value of a parameter.
struct ValueRange {
  double low = 0.0, high = 0.0;
};

/// @returns whether a range is no more than half of a span, in its scale
[[nodiscard]] inline bool is_decided(const ValueRange& range, const Span& span) {
  return part_at(span, range.high) - part_at(span, range.low) <= 0.5;
}

/// Deviations of one signal with the best values.
struct SignalSummary {
  std::size_t signal = 0;  ///< index in FitProblem::signals
  std::optional<SignalError> fitted, held_back;
};

/// State of a fit.
struct FitSummary {
  FitStage stage = FitStage::kDesign;
  std::vector<FitPointSummary> points;  ///< in the order of asking
  std::optional<FitBasis> basis{};
  std::optional<SignalDivergence> divergence{};
  std::optional<std::size_t> best{};        ///< index of the point with the least sum
  std::optional<std::string> local_end{};   ///< end of the least squares, a sentence
  bool budget_ended_local = false;          ///< whether the budget was that end
  std::optional<FitIntervals> intervals{};  ///< at the best point
  std::optional<std::vector<ProfileInterval>> profiles{};
  std::vector<ValueRange> ranges{};  ///< of points about as good as the best; empty where profiles are
  std::vector<std::string> remarks{};  ///< sentences: what is not identifiable, and what to mind
  std::vector<SignalSummary> signals{};
};

}  // namespace jobs
