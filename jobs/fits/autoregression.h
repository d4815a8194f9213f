// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace jobs {

/// Autoregressive model of a stationary series, r_t = a_1 r_(t-1) + ... + a_p r_(t-p) + e_t.
struct Autoregression {
  std::vector<double> coefficients;  ///< a_1 to a_p
  double innovation = 0.0;           ///< variance of e
  double variance = 0.0;             ///< mean square of r
};

/// Burg's method. The order is the one with the least Bayesian information criterion, at most 10 log10(n) and
/// a quarter of the samples. Source: Percival & Walden (1993), Spectral Analysis for Physical Applications.
[[nodiscard]] Autoregression fit_autoregression(std::span<const double> series);

/// Integrated autocorrelation time in samples: the spectral density at frequency 0 over the variance. 1 for
/// white noise.
[[nodiscard]] double calc_autocorrelation_time(const Autoregression& model);

}  // namespace jobs
