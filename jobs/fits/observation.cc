// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/observation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/errors.h"

namespace jobs {
namespace {

/// Slope at a sample of the parabola through it and its neighbours, at an end through the next two; of two
/// samples that of their line.
double slope_at(std::span<const double> t, std::span<const double> y, std::size_t k) {
  const auto chord = [&](std::size_t i) { return (y[i + 1] - y[i]) / (t[i + 1] - t[i]); };
  const std::size_t n = t.size();
  if (n == 2) return chord(0);
  const std::size_t middle = std::clamp<std::size_t>(k, 1, n - 2);
  const double before = t[middle] - t[middle - 1], after = t[middle + 1] - t[middle];
  const double curvature = (chord(middle) - chord(middle - 1)) / (before + after);
  return chord(middle - 1) + curvature * (2.0 * t[k] - t[middle] - t[middle - 1]);
}

double hermite(std::span<const double> t, std::span<const double> y, std::size_t k, double at) {
  const double width = t[k + 1] - t[k];
  const double s = (at - t[k]) / width;
  const double left = (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s);
  return left * y[k] + (1.0 - left) * y[k + 1] +
         width * s * (1.0 - s) * ((1.0 - s) * slope_at(t, y, k) - s * slope_at(t, y, k + 1));
}

/// Output of a filter and its rate.
struct FilterState {
  double y = 0.0, rate = 0.0;
};

/// One step with the input u + slope (time since the step's begin): the response to the ramp, and a decaying
/// difference from it.
FilterState advance(FilterState state, double u, double slope, double dt, double omega) {
  const double decay = omega / std::numbers::sqrt2;  // and the frequency of the oscillation, too
  const double lag = slope * std::numbers::sqrt2 / omega;
  const double cosine = state.y - u + lag;
  const double sine = (state.rate - slope + decay * cosine) / decay;
  const double e = std::exp(-decay * dt), c = std::cos(decay * dt), s = std::sin(decay * dt);
  const double difference = e * (cosine * c + sine * s);
  return {u + slope * dt - lag + difference,
          slope - decay * difference + decay * e * (sine * c - cosine * s)};
}

bool is_in(const std::vector<TimeWindow>& windows, double t) {
  return std::ranges::any_of(windows, [t](const TimeWindow& w) { return t >= w.from_s && t <= w.to_s; });
}

/// Third divided difference of four samples, over its standard deviation where these are noise of
/// deviation 1.
double calc_third_difference(std::span<const double> t, std::span<const double> y) {
  const double length = t[3] - t[0];
  double difference = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    double weight = 1.0;
    for (std::size_t j = 0; j < 4; ++j)
      if (j != i) weight *= length / (t[i] - t[j]);
    difference += weight * y[i];
    squares += weight * weight;
  }
  return difference / std::sqrt(squares);
}

}  // namespace

std::vector<double> filter_low_pass(std::span<const double> t, std::span<const double> y, double cutoff_hz) {
  engine::require(cutoff_hz > 0.0, "cutoff_hz", "above 0");
  std::vector<double> filtered(y.begin(), y.end());
  if (y.empty()) return filtered;
  const double omega = 2.0 * std::numbers::pi * cutoff_hz;
  FilterState state{y[0], 0.0};
  for (std::size_t k = 1; k < y.size(); ++k) {
    const double dt = t[k] - t[k - 1];
    if (dt > 0.0) state = advance(state, y[k - 1], (y[k] - y[k - 1]) / dt, dt, omega);
    filtered[k] = state.y;
  }
  return filtered;
}

std::optional<std::vector<double>> interpolate(std::span<const double> t, std::span<const double> y,
                                               std::span<const double> at, Interpolation kind) {
  engine::require(t.size() >= 2 && t.size() == y.size(), "t", "two samples or more, as many as of y");
  std::vector<double> values;
  for (const double time : at) {
    if (!(time >= t.front() && time <= t.back())) return std::nullopt;
    const auto after = std::upper_bound(t.begin() + 1, t.end() - 1, time);
    const auto k = static_cast<std::size_t>(after - t.begin()) - 1;
    values.push_back(kind == Interpolation::kCubic
                         ? hermite(t, y, k, time)
                         : std::lerp(y[k], y[k + 1], (time - t[k]) / (t[k + 1] - t[k])));
  }
  return values;
}

std::optional<std::vector<double>> predict_signal(std::span<const double> t, std::span<const double> y,
                                                  const SensorModel& sensor,
                                                  std::span<const double> measured_t) {
  std::vector<double> at(measured_t.begin(), measured_t.end());
  for (double& time : at) time -= sensor.delay_s;
  auto signal = sensor.cutoff_hz == 0.0
                    ? interpolate(t, y, at, sensor.interpolation)
                    : interpolate(t, filter_low_pass(t, y, sensor.cutoff_hz), at, sensor.interpolation);
  if (!signal) return std::nullopt;
  for (double& value : *signal) value = sensor.gain * value + sensor.offset;
  return signal;
}

double estimate_noise(std::span<const double> t, std::span<const double> y) {
  std::vector<double> differences;
  for (std::size_t k = 3; k < y.size(); ++k)
    differences.push_back(std::abs(calc_third_difference(t.subspan(k - 3, 4), y.subspan(k - 3, 4))));
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  constexpr double kMedianOfNormal = 0.67448975;
  return *middle / kMedianOfNormal;
}

std::vector<std::size_t> select_samples(const MeasuredSignal& measured, Samples which) {
  std::vector<std::size_t> selected;
  for (std::size_t k = 0; k < measured.t.size(); ++k) {
    const bool held_back = is_in(measured.held_back, measured.t[k]);
    const bool fitted = !held_back && (measured.fitted.empty() || is_in(measured.fitted, measured.t[k]));
    if (which == Samples::kHeldBack ? held_back : fitted) selected.push_back(k);
  }
  return selected;
}

std::optional<std::vector<double>> calc_residuals(const MeasuredSignal& measured, Samples which,
                                                  std::span<const double> t, std::span<const double> y,
                                                  const SensorModel& sensor) {
  const auto selected = select_samples(measured, which);
  std::vector<double> times;
  for (const std::size_t k : selected) times.push_back(measured.t[k]);
  auto residuals = predict_signal(t, y, sensor, times);
  if (!residuals) return std::nullopt;
  for (std::size_t i = 0; i < selected.size(); ++i)
    (*residuals)[i] = ((*residuals)[i] - measured.y[selected[i]]) / measured.sigma;
  return residuals;
}

double sum_of_squares(std::span<const double> values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

}  // namespace jobs
