// SPDX-License-Identifier: Apache-2.0
#include "jobs/motion/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>

#include <unsupported/Eigen/FFT>

#include "jobs/base/errors.h"

namespace jobs {
namespace {

constexpr std::size_t kFewestSamples = 16;

bool is_smooth(std::size_t n) {
  for (const std::size_t prime : {2U, 3U, 5U}) {
    while (n % prime == 0) n /= prime;
  }
  return n == 1;
}

/// The longest first part whose length is smooth.
std::span<const double> cut_to_smooth_length(std::span<const double> samples) {
  std::size_t n = samples.size();
  while (!is_smooth(n)) --n;
  return samples.first(n);
}

/// Sums of cosines over a whole period, with alternating signs.
double window_at(Window window, double part) {
  constexpr std::array<double, 5> kFlatTop{0.21557895, 0.41663158, 0.277263158, 0.083578947, 0.006947368};
  const double phase = 2.0 * std::numbers::pi * part;
  if (window == Window::kRectangular) return 1.0;
  if (window == Window::kHann) return 0.5 - 0.5 * std::cos(phase);
  double sum = 0.0;
  for (std::size_t k = 0; k < kFlatTop.size(); ++k)
    sum += (k % 2 == 0 ? 1.0 : -1.0) * kFlatTop[k] * std::cos(static_cast<double>(k) * phase);
  return sum;
}

/// Samples without their mean, times a window, and the sums of its weights and of their squares.
struct WindowedSamples {
  std::vector<double> values;
  double weights = 0.0, squares = 0.0;
};

WindowedSamples apply_window(std::span<const double> samples, double mean, Window window) {
  WindowedSamples made;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double w = window_at(window, static_cast<double>(k) / static_cast<double>(samples.size()));
    made.values.push_back(w * (samples[k] - mean));
    made.weights += w;
    made.squares += w * w;
  }
  return made;
}

/// Fourier transform at the frequencies from 0 to half the rate.
std::vector<std::complex<double>> transform_half(const std::vector<double>& values) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> transformed;
  fft.fwd(transformed, values);
  return transformed;
}

/// The samples that follow each other at the rate of the first two; a run may end between two of them.
std::size_t count_even_samples(const std::vector<double>& t) {
  const double step = t[1] - t[0];
  const bool uneven_end = std::abs(t.back() - t[t.size() - 2] - step) > 1e-6 * step;
  return t.size() - (uneven_end ? 1 : 0);
}

}  // namespace

std::optional<Window> find_window(std::string_view name) {
  const auto found = std::ranges::find(kWindowNames, name);
  return found == std::end(kWindowNames)
             ? std::nullopt
             : std::optional(static_cast<Window>(found - std::begin(kWindowNames)));
}

Spectrum calc_spectrum(std::span<const double> samples, double rate, Window window) {
  samples = cut_to_smooth_length(samples);
  const std::size_t n = samples.size();
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(n);
  const WindowedSamples windowed = apply_window(samples, mean, window);
  const std::vector<std::complex<double>> transformed = transform_half(windowed.values);
  Spectrum spectrum;
  for (std::size_t k = 0; k < n / 2 + 1; ++k) {
    const bool alone = k == 0 || 2 * k == n;  // without a mirror image
    const double size = std::abs(transformed[k]);
    spectrum.frequency.push_back(rate * static_cast<double>(k) / static_cast<double>(n));
    spectrum.amplitude.push_back(k == 0 ? std::abs(mean) : (alone ? 1.0 : 2.0) * size / windowed.weights);
    spectrum.density.push_back((alone ? 1.0 : 2.0) * size * size / (rate * windowed.squares));
  }
  return spectrum;
}

engine::Trajectory make_spectrum(const engine::Trajectory& run, Window window) {
  const std::vector<double>& t = run.columns.at(0);
  if (t.size() < kFewestSamples)
    throw WrongState("a spectrum needs at least " + std::to_string(kFewestSamples) + " samples; there are " +
                     std::to_string(t.size()));
  const auto samples = std::span(run.columns.at(1)).first(count_even_samples(t));
  const std::string& channel = run.channels.at(1).key;
  if (!std::ranges::all_of(samples, [](double x) { return std::isfinite(x); }))
    throw WrongState(channel + " has no values in this job");
  Spectrum spectrum = calc_spectrum(samples, 1.0 / (t[1] - t[0]), window);
  return {
      .channels = {{.key = "frequency_hz", .help = "frequency"},
                   {.key = channel, .help = "amplitude of a sine of that frequency"},
                   {.key = channel + "_squared_per_hz", .help = "power spectral density"}},
      .columns = {std::move(spectrum.frequency), std::move(spectrum.amplitude), std::move(spectrum.density)}};
}

}  // namespace jobs
