// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/analysis/quantities.h"

namespace jobs {

/// Window function of the samples before the transform: hann tells neighbouring frequencies apart, flat_top
/// measures amplitudes between the lines of the spectrum, rectangular leaves the samples as they are.
enum class Window { kHann, kFlatTop, kRectangular };
inline constexpr std::string_view kWindowNames[] = {"hann", "flat_top", "rectangular"};
[[nodiscard]] std::optional<Window> find_window(std::string_view name);

/// One side of the spectrum of equally spaced samples.
struct Spectrum {
  std::vector<double> frequency;  ///< [Hz], from 0 to half the sampling rate
  /// Of a sine of that frequency, in the samples' unit; at 0 the magnitude of the mean
  std::vector<double> amplitude;
  /// Power spectral density of what deviates from the mean, in the square of the unit per Hz
  std::vector<double> density;
};

/// The mean is taken off before the samples are multiplied by the window. Of n samples the first m are used,
/// m the largest number up to n without a prime factor above 5: other lengths would cost far more.
/// @param samples  two or more, finite
/// @param rate  [Hz], > 0
[[nodiscard]] Spectrum calc_spectrum(std::span<const double> samples, double rate, Window window);

/// The spectrum of one channel as a table: frequency_hz, the channel (its amplitude) and
/// <channel>_squared_per_hz.
/// @param run  t_s and the channel
/// @throws WrongState if there are fewer than 16 samples, or the channel has no values
[[nodiscard]] engine::Trajectory make_spectrum(const engine::Trajectory& run, Window window);

}  // namespace jobs
