// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/errors.h"
#include "jobs/motion/spectrum.h"
#include "jobs/statistics/replicate_statistics.h"

namespace jobs {
namespace {

constexpr std::size_t kSegment = 1024;  // samples of Welch's segments

/// Quantile between the neighbouring order statistics. @param sorted  one or more
double quantile_of(const std::vector<double>& sorted, double part) {
  const double place = part * static_cast<double>(sorted.size() - 1);
  const auto k = static_cast<std::size_t>(place);
  const std::size_t next = std::min(k + 1, sorted.size() - 1);
  return std::lerp(sorted[k], sorted[next], place - static_cast<double>(k));
}

/// Largest magnitudes of whole stretches of the signal, ascending.
std::vector<double> sorted_peaks(std::span<const double> t, std::span<const double> y, double period) {
  const double step = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  const auto count = static_cast<std::size_t>((t.back() - t.front() + step) / period * (1.0 + 1e-9));
  std::vector<double> peaks(count, 0.0);
  for (std::size_t k = 0; k < t.size(); ++k) {
    const auto stretch = static_cast<std::size_t>((t[k] - t.front()) / period * (1.0 + 1e-9));
    if (stretch < count) peaks[stretch] = std::max(peaks[stretch], std::abs(y[k]));
  }
  std::ranges::sort(peaks);
  return peaks;
}

std::size_t count_impacts(std::span<const double> t, std::span<const double> y,
                          const FeatureOptions& options) {
  std::size_t count = 0;
  double last = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (std::abs(y[k]) <= options.threshold) continue;
    if (t[k] - last > options.refractory_s) ++count;
    last = t[k];
  }
  return count;
}

/// RMS within each octave.
std::vector<double> calc_bands(std::span<const double> y, double rate, const FeatureOptions& options) {
  const std::size_t length = std::min(kSegment, y.size());
  std::vector<double> power(options.bands, 0.0);
  std::size_t segments = 0;
  for (std::size_t from = 0; from + length <= y.size(); from += std::max<std::size_t>(length / 2, 1)) {
    const Spectrum spectrum = calc_spectrum(y.subspan(from, length), rate, Window::kHann);
    ++segments;
    for (std::size_t k = 1; k < spectrum.frequency.size(); ++k) {
      const double octave = std::floor(std::log2(spectrum.frequency[k] / options.lowest_band_hz));
      if (octave < 0.0 || octave >= static_cast<double>(options.bands)) continue;
      power[static_cast<std::size_t>(octave)] += spectrum.density[k] * spectrum.frequency[1];
    }
  }
  for (double& p : power) p = std::sqrt(p / static_cast<double>(segments));
  return power;
}

}  // namespace

std::vector<double> calc_features(std::span<const double> t, std::span<const double> y,
                                  const FeatureOptions& options) {
  engine::require(t.size() >= 2 && t.size() == y.size(), "t", "two samples or more, as many as of y");
  engine::require(options.cycle_s > 0.0, "cycle_s", "above 0");
  engine::require(options.bands == 0 || options.lowest_band_hz > 0.0, "lowest_band_hz", "above 0");
  const std::vector<double> peaks = sorted_peaks(t, y, options.cycle_s);
  engine::require(!peaks.empty(), "t", "as long as one cycle");
  const std::vector<double> envelope = sorted_peaks(t, y, options.cycle_s / 8.0);
  const double cycles = (t.back() - t.front()) / options.cycle_s;
  const double squares = std::inner_product(y.begin(), y.end(), y.begin(), 0.0);
  std::vector<double> features{
      std::accumulate(peaks.begin(), peaks.end(), 0.0) / static_cast<double>(peaks.size()),
      quantile_of(peaks, 0.1),
      quantile_of(peaks, 0.5),
      quantile_of(peaks, 0.9),
      std::sqrt(squares / static_cast<double>(y.size())),
      static_cast<double>(count_impacts(t, y, options)) / cycles,
      quantile_of(envelope, 0.5),
      quantile_of(envelope, 0.95)};
  const double rate = static_cast<double>(t.size() - 1) / (t.back() - t.front());
  const std::vector<double> bands = calc_bands(y, rate, options);
  features.insert(features.end(), bands.begin(), bands.end());
  return features;
}

FeatureScatter calc_scatter(std::span<const std::vector<double>> replicates) {
  engine::require(replicates.size() >= 2, "replicates", "two or more");
  FeatureScatter scatter;
  for (std::size_t f = 0; f < replicates[0].size(); ++f) {
    std::vector<double> values;
    for (const auto& replicate : replicates) values.push_back(replicate.at(f));
    const ReplicateStatistics statistics = calc_replicate_statistics(values);
    scatter.mean.push_back(*statistics.mean);
    scatter.deviation.push_back(*statistics.spread);
  }
  return scatter;
}

}  // namespace jobs
