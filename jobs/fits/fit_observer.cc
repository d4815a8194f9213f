// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "jobs/base/errors.h"
#include "jobs/fits/autoregression.h"
#include "jobs/fits/features.h"
#include "jobs/fits/fit_cases.h"
#include "jobs/trajectories/trajectory_codec.h"
#include "jobs/trajectories/trajectory_query.h"

namespace jobs {
namespace {

/// Impacts: samples above so many times the RMS, and no nearer to each other than so many a cycle.
constexpr double kImpactOverRms = 3.0;
constexpr double kMostImpactsOfACycle = 20.0;
constexpr double kMostOctaves = 8.0;
constexpr double kHighestOverRate = 0.4;  ///< of the sampling rate; half of it is Nyquist's frequency

/// Noise: the part of the variance that earlier samples do not tell, and the most excess kurtosis beside five
/// standard errors of it.
constexpr double kWhitePart = 0.9;
constexpr double kExcessKurtosis = 0.5;
constexpr std::size_t kFewestForTest = 50;
constexpr double kLeastDeviation = 1e-6;

double rms_of(std::span<const double> y) {
  double squares = 0.0;
  for (const double value : y) squares += value * value;
  return y.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(y.size()));
}

/// Fourth moment over the square of the second, less that of a normal distribution.
double excess_kurtosis(std::span<const double> y) {
  double second = 0.0;
  double fourth = 0.0;
  for (const double value : y) {
    second += value * value;
    fourth += std::pow(value, 4);
  }
  return second > 0.0 ? fourth * static_cast<double>(y.size()) / (second * second) - 3.0 : 0.0;
}

double mean_of(std::span<const double> y) {
  double sum = 0.0;
  for (const double value : y) sum += value;
  return y.empty() ? 0.0 : sum / static_cast<double>(y.size());
}

/// Evenly spaced times between the first and the last of the compared samples, as many as there are measured
/// ones.
std::vector<double> even_times(const FitSignal& signal) {
  const auto& t = signal.measured.t;
  const double from = signal.compared.t.front();
  const double to = signal.compared.t.back();
  const double step = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  std::vector<double> times;
  for (std::size_t k = 0; from + step * static_cast<double>(k) <= to; ++k)
    times.push_back(from + step * static_cast<double>(k));
  return times;
}

FeatureOptions options_of(const FitSignal& signal) {
  const auto& t = signal.measured.t;
  const double rate = static_cast<double>(t.size() - 1) / (t.back() - t.front());
  const double octaves = std::floor(std::log2(kHighestOverRate * rate * signal.cycle_s));
  return {.cycle_s = signal.cycle_s,
          .threshold = kImpactOverRms * rms_of(signal.compared.y),
          .refractory_s = signal.cycle_s / kMostImpactsOfACycle,
          .lowest_band_hz = 1.0 / signal.cycle_s,
          .bands = static_cast<std::size_t>(std::clamp(octaves, 0.0, kMostOctaves))};
}

/// Predicted signal of each point, over sigma. @param first  residual of the signal
std::vector<std::vector<double>> predictions_of(const FitSignal& signal, std::size_t first,
                                                const std::vector<std::vector<double>>& residuals) {
  std::vector<std::vector<double>> predictions;
  for (const std::vector<double>& one : residuals) {
    auto& prediction = predictions.emplace_back();
    for (std::size_t k = 0; k < signal.compared.t.size(); ++k)
      prediction.push_back(one[first + k] + signal.compared.y[k] / signal.compared.sigma);
  }
  return predictions;
}

/// @returns whether the compared samples are some cycles long, and dense enough
bool has_features(const FitSignal& signal) {
  const auto& t = signal.compared.t;
  return t.size() > kFewestForTest && signal.cycle_s > 0.0 && t.back() - t.front() > 2.0 * signal.cycle_s &&
         even_times(signal).size() > kFewestForTest;
}

}  // namespace

FitObserver::FitObserver(std::shared_ptr<const FitProblem> problem, const SweepReader& reader)
    : problem_(std::move(problem)), reader_(reader) {
  for (const FitSignal& signal : problem_->signals) {
    if (problem_->basis == FitBasis::kPointWise || !has_features(signal)) continue;
    const std::vector<double> times = even_times(signal);
    const auto y = interpolate(signal.measured.t, signal.measured.y, times, Interpolation::kLinear);
    const std::vector<double> features = calc_features(times, y.value(), options_of(signal));
    measured_features_.insert(measured_features_.end(), features.begin(), features.end());
  }
}

std::optional<FitObserver::Series> FitObserver::read(const std::string& job_id,
                                                     const std::string& channel) const {
  const auto blob = reader_.find_trajectory(job_id);
  if (!blob) return std::nullopt;
  try {
    auto trajectory =
        decode_trajectory(std::as_bytes(std::span(*blob)), std::array{std::string("t_s"), channel});
    if (trajectory.columns.size() != 2 || trajectory.columns[0].size() < 2) return std::nullopt;
    return Series{std::move(trajectory.columns[0]), std::move(trajectory.columns[1])};
  } catch (const DamagedTrajectory&) {
    return std::nullopt;
  }
}

std::optional<Observation> FitObserver::observe(const FitPoint& point,
                                                const std::vector<std::string>& job_ids,
                                                Wanted wanted) const {
  Observation made;
  for (const FitSignal& signal : problem_->signals) {
    if (signal.compared.t.empty()) continue;
    const auto series = read(job_ids[signal.run], signal.channel);
    if (!series) return std::nullopt;
    const SensorModel sensor = sensor_of(*problem_, signal, point);
    const auto residuals = calc_residuals(signal.compared, Samples::kFitted, series->t, series->y, sensor);
    if (!residuals) return std::nullopt;
    made.residuals.insert(made.residuals.end(), residuals->begin(), residuals->end());
    if (wanted == Wanted::kResiduals || !has_features(signal)) continue;
    const std::vector<double> times = even_times(signal);
    const auto y = predict_signal(series->t, series->y, sensor, times);
    if (!y) return std::nullopt;
    const std::vector<double> features = calc_features(times, *y, options_of(signal));
    made.features.insert(made.features.end(), features.begin(), features.end());
  }
  return made;
}

bool FitObserver::is_noise(const std::vector<double>& residuals) const {
  std::size_t first = 0;
  for (const FitSignal& signal : problem_->signals) {
    const std::size_t count = signal.compared.t.size();
    const std::span<const double> block = std::span(residuals).subspan(first, count);
    first += count;
    if (count < kFewestForTest) continue;
    const Autoregression model = fit_autoregression(block);
    const double allowed = kExcessKurtosis + 5.0 * std::sqrt(24.0 / static_cast<double>(count));
    if (model.innovation < kWhitePart * model.variance || excess_kurtosis(block) > allowed) return false;
  }
  return true;
}

std::vector<double> FitObserver::calc_deviations(const std::vector<double>& residuals) const {
  std::vector<double> deviations;
  std::size_t first = 0;
  for (const FitSignal& signal : problem_->signals) {
    const std::size_t count = signal.compared.t.size();
    const double rms = rms_of(std::span(residuals).subspan(first, count));
    const double noise = signal.noise / signal.measured.sigma;
    deviations.push_back(count == 0 ? 1.0
                                    : std::max(std::hypot(rms, noise), signal.weight * kLeastDeviation));
    first += count;
  }
  return deviations;
}

double FitObserver::calc_loss(const std::vector<double>& deviations) const {
  double loss = 0.0;
  double samples = 0.0;
  for (std::size_t k = 0; k < deviations.size(); ++k) {
    const FitSignal& signal = problem_->signals[k];
    const double count = signal.weight * signal.weight * static_cast<double>(signal.compared.t.size());
    loss += count * std::log(deviations[k]);
    samples += count;
  }
  return loss / samples;
}

std::vector<double> FitObserver::scale_signals(std::vector<double> residuals,
                                               const std::vector<double>& factors) const {
  auto next = residuals.begin();
  for (std::size_t k = 0; k < problem_->signals.size(); ++k)
    for (std::size_t left = problem_->signals[k].compared.t.size(); left > 0; --left) *next++ *= factors[k];
  return residuals;
}

double FitObserver::misfit(const std::vector<double>& residuals) const {
  double sum = 0.0;
  std::size_t first = 0;
  for (const FitSignal& signal : problem_->signals) {
    const std::size_t count = signal.compared.t.size();
    const double rms = rms_of(std::span(residuals).subspan(first, count));
    const double noise = signal.noise / signal.measured.sigma;
    sum += static_cast<double>(count) * std::max(0.0, rms * rms - noise * noise);
    first += count;
  }
  return sum;
}

double FitObserver::misfit_of_noise() const {
  // Variances, times the number of samples, of a mean square and of the square of estimate_noise(), relative
  // to the square of what they estimate. The second was drawn.
  constexpr double kOfMeanSquare = 2.0;
  constexpr double kOfEstimate = 5.5;
  constexpr double kQuantile = 1.645;  // of the normal distribution, at 0.95
  double variance = 0.0;
  for (const FitSignal& signal : problem_->signals) {
    const auto count = static_cast<double>(signal.compared.t.size());
    if (count == 0.0) continue;
    const double noise = signal.noise / signal.measured.sigma;
    const auto estimated_from = static_cast<double>(signal.noise_samples);
    const double relative =
        kOfMeanSquare / count + (signal.noise_samples > 0 ? kOfEstimate / estimated_from : 0.0);
    variance += std::pow(count * noise * noise, 2) * relative;
  }
  return kQuantile * std::sqrt(variance);
}

std::optional<Prediction> FitObserver::predict(const FitSignal& signal, const FitPoint& point,
                                               const std::vector<std::string>& job_ids) const {
  if (signal.run >= job_ids.size()) return std::nullopt;
  const auto series = read(job_ids[signal.run], signal.channel);
  if (!series) return std::nullopt;
  auto predicted =
      predict_signal(series->t, series->y, sensor_of(*problem_, signal, point), signal.measured.t);
  if (!predicted) return std::nullopt;
  return Prediction{signal.measured.t, signal.measured.y, std::move(*predicted)};
}

std::optional<SignalError> FitObserver::compare(const FitSignal& signal, const Prediction& prediction,
                                                Samples which) {
  SignalError error;
  std::vector<double> differences;
  std::vector<double> measured;
  for (const std::size_t k : select_samples(signal.measured, which)) {
    differences.push_back(prediction.predicted[k] - prediction.measured[k]);
    measured.push_back(prediction.measured[k]);
    error.measured_peak = std::max(error.measured_peak, std::abs(prediction.measured[k]));
    error.predicted_peak = std::max(error.predicted_peak, std::abs(prediction.predicted[k]));
  }
  if (measured.empty()) return std::nullopt;
  error.samples = measured.size();
  error.rms = rms_of(differences);
  const double mean = mean_of(measured);
  for (double& value : measured) value -= mean;
  const double variation = rms_of(measured);
  // Rounding of the mean leaves a constant signal some variation.
  constexpr double kConstant = 1e-13;  // of the mean
  if (variation > kConstant * std::abs(mean)) error.relative_rms = error.rms / variation;
  return error;
}

SignalDivergence FitObserver::judge(const std::vector<std::vector<double>>& residuals) const {
  SignalDivergence largest;
  std::size_t first = 0;
  for (const FitSignal& signal : problem_->signals) {
    const std::size_t count = signal.compared.t.size();
    if (count < 2) {
      first += count;
      continue;
    }
    const SignalDivergence divergence = judge_divergence(predictions_of(signal, first, residuals));
    if (largest.message.empty() || divergence.ratio > largest.ratio) largest = divergence;
    first += count;
  }
  return largest;
}

}  // namespace jobs
