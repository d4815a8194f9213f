// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_signals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

using nlohmann::json;

/// Samples of jobs per second, and for each measured one where these are not evenly spaced.
constexpr double kLeastRate = 1000.0;
constexpr double kLargestRate = 1e5;
constexpr double kRateOverUneven = 10.0;

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

std::vector<TimeWindow> shift_windows(std::vector<TimeWindow> windows, double by_s) {
  for (TimeWindow& window : windows) {
    window.from_s += by_s;
    window.to_s += by_s;
  }
  return windows;
}

/// Takes the samples within the job, with any delay that the fit may find.
void take_samples(const SignalSource& source, double shift_s, FitSignal& signal) {
  const MeasuredChannel& channel = source.measurement.measurement.channels[source.column];
  const MeasuredRun& run = source.measurement.measurement.runs[source.run];
  const double job_end = source.job_parameters.at("duration_s").get<double>();
  MeasuredSignal& taken = signal.measured;
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    const double t = run.time_s[k] + shift_s;
    if (t - source.delays.to < 0.0 || t - source.delays.from > job_end) continue;
    if (taken.t.empty()) signal.first_sample = k;
    taken.t.push_back(t);
    taken.y.push_back(channel.sign * channel.gain * run.columns[source.column][k] + channel.offset);
  }
}

void set_windows(MeasuredSignal& signal, const SignalSource& source, double shift_s) {
  const FittedMeasurement& of = source.measurement;
  signal.fitted = shift_windows(of.fitted, shift_s);
  signal.held_back = shift_windows(of.held_back, shift_s);
  // The steady window: what comes before depends on how the machine was started.
  const double steady_from = source.job_parameters.at("run_up_s").get<double>();
  if (of.fitted.empty()) signal.fitted = {{.from_s = steady_from, .to_s = kNoEnd}};
  if (!of.held_back_runs.contains(source.run)) return;
  signal.held_back.insert(signal.held_back.end(), signal.fitted.begin(), signal.fitted.end());
  signal.fitted = {{.from_s = kNoEnd, .to_s = kNoEnd}};
}

void set_scale(FitSignal& signal, const json& options) {
  std::vector<double> times;
  std::vector<double> fitted;
  for (const std::size_t k : select_samples(signal.measured, Samples::kFitted)) {
    times.push_back(signal.measured.t[k]);
    fitted.push_back(signal.measured.y[k]);
  }
  const auto count = static_cast<double>(fitted.size());
  double mean = 0.0;
  double squares = 0.0;
  for (const double y : fitted) mean += y / count;
  for (const double y : fitted) squares += std::pow(y - mean, 2);
  double sigma = fitted.empty() ? 1.0 : std::sqrt(squares / count);
  if (options.contains("noise")) {
    signal.noise = sigma = options.at("noise").get<double>();
  } else if (fitted.size() > kFewestForNoise) {
    signal.noise = estimate_noise(times, fitted);
    signal.noise_samples = fitted.size();
  }
  signal.weight = options.value("weight", 1.0);
  signal.measured.sigma = sigma / signal.weight;
}

}  // namespace

FitSignal make_fit_signal(const SignalSource& source) {
  const FittedMeasurement& of = source.measurement;
  const MeasuredChannel& channel = of.measurement.channels[source.column];
  const double shift_s = of.time_shift_s - channel.delay_s;
  FitSignal signal;
  signal.channel = channel.name;
  take_samples(source, shift_s, signal);
  set_windows(signal.measured, source, shift_s);
  signal.sensor.cutoff_hz = channel.low_pass_hz.value_or(0.0);
  set_scale(signal, of.channels.contains(channel.name) ? of.channels.at(channel.name) : json::object());
  return signal;
}

std::string describe_scale_fault(const FitSignal& signal) {
  if (std::isnormal(signal.measured.sigma)) return {};
  return "does not vary, or squares of its samples, noise or weight are no numbers: give another noise";
}

double find_output_rate(const std::vector<double>& time_s) {
  std::vector<double> steps(time_s.size());
  std::adjacent_difference(time_s.begin(), time_s.end(), steps.begin());
  steps.erase(steps.begin());
  const double mean = (time_s.back() - time_s.front()) / static_cast<double>(steps.size());
  bool even = true;
  for (std::size_t k = 1; k < time_s.size(); ++k)
    even = even && std::abs(time_s[k] - time_s.front() - mean * static_cast<double>(k)) <= 1e-3 * mean;
  const double rate = std::stod(number_text(std::round(1e6 / mean) / 1e6));
  if (even && rate > 0.0 && rate <= kLargestRate)
    return rate * std::ceil(std::min(kLeastRate / rate, 1e3));
  const auto median = steps.begin() + std::ssize(steps) / 2;
  std::ranges::nth_element(steps, median);
  return std::round(std::clamp(kRateOverUneven / *median, kLeastRate, kLargestRate));
}

}  // namespace jobs
