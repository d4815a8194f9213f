// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jobs/fits/divergence.h"
#include "jobs/fits/evaluations.h"
#include "jobs/fits/fit_problem.h"
#include "jobs/store/sweep_reader.h"

namespace jobs {

/// Comparison of the jobs at one point with the measured signals.
struct Observation {
  std::vector<double> residuals;  ///< of the compared samples, signal by signal, over sigma
  std::vector<double> features;   ///< of the signals, signal by signal; empty unless they are asked for
};

/// Signal that is predicted at all measured times.
struct Prediction {
  std::vector<double> t, measured, predicted;
};

/// Deviation of a predicted signal from the measured one.
struct SignalError {
  std::size_t samples = 0;
  double rms = 0.0;           ///< in the unit of the channel
  /// over the RMS of the measured samples about their mean; empty if they do not vary
  std::optional<double> relative_rms = {};
  double measured_peak = 0.0, predicted_peak = 0.0;  ///< largest magnitudes
};

/// Compares trajectories of jobs with measured signals, through the models of their sensors.
class FitObserver {
 public:
  /// @param reader  of the trajectories; outlives this
  FitObserver(std::shared_ptr<const FitProblem> problem, const SweepReader& reader);

  [[nodiscard]] const FitProblem& problem() const { return *problem_; }

  enum class Wanted { kResiduals, kFeaturesToo };
  /// @param job_ids  one a run; those of runs that are held back may be empty  @returns empty if a job has no
  /// trajectory that covers the samples
  [[nodiscard]] std::optional<Observation> observe(const FitPoint& point,
                                                   const std::vector<std::string>& job_ids,
                                                   Wanted wanted) const;
  /// @returns whether the residuals of each signal are white, without the spikes that impacts leave that come
  /// too early or too late
  [[nodiscard]] bool is_noise(const std::vector<double>& residuals) const;
  /// Part of the sum of squares beyond that of the noise.
  [[nodiscard]] double misfit(const std::vector<double>& residuals) const;
  /// Misfit that residuals exceed in one of twenty fits that leave nothing but noise: their mean square
  /// scatters, and so does the noise that few samples tell.
  [[nodiscard]] double misfit_of_noise() const;
  /// Deviation of each signal: RMS of its residuals and its noise together, so that a fit is not led by what
  /// is below the noise. 1: no sample of it is compared.
  [[nodiscard]] std::vector<double> calc_deviations(const std::vector<double>& residuals) const;
  /// Negative logarithm of the likelihood if the noise of each signal is unknown, for each sample. Signals
  /// that the model reproduces count for more than those that it does not: a sum of squares weighs them the
  /// other way round.
  [[nodiscard]] double calc_loss(const std::vector<double>& deviations) const;
  /// Residuals of each signal times its factor.
  [[nodiscard]] std::vector<double> scale_signals(std::vector<double> residuals,
                                                  const std::vector<double>& factors) const;
  [[nodiscard]] const std::vector<double>& measured_features() const { return measured_features_; }

  /// Whole signal. @returns empty as observe() does
  [[nodiscard]] std::optional<Prediction> predict(const FitSignal& signal, const FitPoint& point,
                                                  const std::vector<std::string>& job_ids) const;
  /// @returns empty if no sample is of that kind
  [[nodiscard]] static std::optional<SignalError> compare(const FitSignal& signal,
                                                          const Prediction& prediction, Samples which);

  /// SignalDivergence of the signals of several points that are beside each other, that of the signal in
  /// which it is largest. @param residuals  of two points or more
  [[nodiscard]] SignalDivergence judge(const std::vector<std::vector<double>>& residuals) const;

 private:
  struct Series {
    std::vector<double> t, y;
  };
  [[nodiscard]] std::optional<Series> read(const std::string& job_id, const std::string& channel) const;

  std::shared_ptr<const FitProblem> problem_;
  const SweepReader& reader_;
  std::vector<double> measured_features_;
};

}  // namespace jobs
