// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace jobs {

enum class Interpolation { kLinear, kCubic };

/// Sensor: y(t) = gain low_pass(channel)(t - delay) + offset. A negative gain turns the sign.
struct SensorModel {
  double gain = 1.0;
  double offset = 0.0;  ///< in the unit of the measured signal
  double delay_s = 0.0;
  double cutoff_hz = 0.0;  ///< of the low-pass; 0: there is none
  Interpolation interpolation = Interpolation::kCubic;
};

/// Butterworth's low-pass of order 2 of a signal that is linear between its samples, exactly, with unit gain
/// at 0 Hz. Before its first sample the signal is constant.
/// @param t  ascending, [s]; steps may differ  @param y  as many  @param cutoff_hz  > 0
[[nodiscard]] std::vector<double> filter_low_pass(std::span<const double> t, std::span<const double> y,
                                                  double cutoff_hz);

/// Signal at given times. Cubic: Hermite's polynomials with the slopes of parabolas through three samples (de
/// Boor (1978), A Practical Guide to Splines, ch. IV, Bessel).
/// @param t   ascending, two or more  @param at  ascending
/// @returns empty if a time is before the first or after the last sample
[[nodiscard]] std::optional<std::vector<double>> interpolate(std::span<const double> t,
                                                             std::span<const double> y,
                                                             std::span<const double> at, Interpolation kind);

/// Signal of the sensor at the measured times. @returns empty if the channel does not cover them
[[nodiscard]] std::optional<std::vector<double>> predict_signal(std::span<const double> t,
                                                                std::span<const double> y,
                                                                const SensorModel& sensor,
                                                                std::span<const double> measured_t);

struct TimeWindow {
  double from_s = 0.0, to_s = 0.0;  ///< both ends belong to it
};

/// Measured samples. Samples in windows of both kinds are held back.
struct MeasuredSignal {
  std::vector<double> t, y;
  std::vector<TimeWindow> fitted;     ///< empty: all samples
  std::vector<TimeWindow> held_back;  ///< to judge the fit by
  double sigma = 1.0;                 ///< scale of its residuals: of the noise, over the weight
};

/// Standard deviation of the noise of samples: by the median of their third divided differences, so that
/// neither what is smooth nor a few spikes count. @param t  ascending  @param y  four or more
[[nodiscard]] double estimate_noise(std::span<const double> t, std::span<const double> y);

enum class Samples { kFitted, kHeldBack };
[[nodiscard]] std::vector<std::size_t> select_samples(const MeasuredSignal& measured, Samples which);

/// (predicted - measured) / sigma at the selected samples.
/// @returns empty if the channel does not cover the times of the selected samples
[[nodiscard]] std::optional<std::vector<double>> calc_residuals(const MeasuredSignal& measured, Samples which,
                                                                std::span<const double> t,
                                                                std::span<const double> y,
                                                                const SensorModel& sensor);

[[nodiscard]] double sum_of_squares(std::span<const double> values);

}  // namespace jobs
