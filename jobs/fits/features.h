// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace jobs {

struct FeatureOptions {
  double cycle_s = 0.0;         ///< period of the drive
  double threshold = 0.0;       ///< magnitude above which a sample belongs to an impact, in the signal's unit
  double refractory_s = 0.0;    ///< impacts nearer to the last one than this count as the same
  double lowest_band_hz = 0.0;  ///< lower end of the first octave
  std::size_t bands = 0;        ///< octaves
};

/// Features of a signal whose samples do not repeat while their distribution does. Peaks are the largest
/// magnitudes of whole cycles, and the envelope is the largest magnitude of each eighth of a cycle. Bands
/// hold the RMS within an octave by Welch's method (1967): segments with a Hann window that overlap by half.
/// @returns mean, 10, 50 and 90 % quantile of the peaks; RMS; impacts per cycle; 50 and 95 % quantile of the
///          envelope; RMS of each band
/// @param t  ascending, evenly spaced, at least one cycle  @param y  as many
[[nodiscard]] std::vector<double> calc_features(std::span<const double> t, std::span<const double> y,
                                                const FeatureOptions& options);

/// Mean and sample deviation of each feature over replicates.
struct FeatureScatter {
  std::vector<double> mean, deviation;
};
/// @param replicates  two or more, one list of features each
[[nodiscard]] FeatureScatter calc_scatter(std::span<const std::vector<double>> replicates);

}  // namespace jobs
