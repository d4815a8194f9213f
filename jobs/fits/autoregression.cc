// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/autoregression.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

namespace jobs {
namespace {

/// Coefficients of the next order from those of the last one (Levinson's recursion).
std::vector<double> raise_order(const std::vector<double>& a, double reflection) {
  std::vector<double> raised = a;
  for (std::size_t i = 0; i < a.size(); ++i) raised[i] -= reflection * a[a.size() - 1 - i];
  raised.push_back(reflection);
  return raised;
}

/// Correlation of the forward errors with the backward errors one sample earlier, over their mean power.
double calc_reflection(const std::vector<double>& forward, const std::vector<double>& backward,
                       std::size_t order) {
  double product = 0.0, power = 0.0;
  for (std::size_t t = order + 1; t < forward.size(); ++t) {
    product += forward[t] * backward[t - 1];
    power += forward[t] * forward[t] + backward[t - 1] * backward[t - 1];
  }
  return power > 0.0 ? 2.0 * product / power : 0.0;
}

}  // namespace

Autoregression fit_autoregression(std::span<const double> series) {
  const auto n = static_cast<double>(series.size());
  Autoregression best;
  if (series.empty()) return best;
  best.variance = std::inner_product(series.begin(), series.end(), series.begin(), 0.0) / n;
  best.innovation = best.variance;
  const auto highest = static_cast<std::size_t>(std::min(10.0 * std::log10(n), n / 4.0));
  std::vector<double> forward(series.begin(), series.end()), backward = forward, a;
  double innovation = best.variance;
  double least = n * std::log(innovation);
  for (std::size_t order = 0; order < highest && innovation > 0.0; ++order) {
    const double reflection = calc_reflection(forward, backward, order);
    for (std::size_t t = series.size() - 1; t > order; --t) {
      const double f = forward[t];
      forward[t] = f - reflection * backward[t - 1];
      backward[t] = backward[t - 1] - reflection * f;
    }
    a = raise_order(a, reflection);
    innovation *= 1.0 - reflection * reflection;
    const double criterion = n * std::log(innovation) + static_cast<double>(order + 1) * std::log(n);
    if (!(criterion < least)) continue;
    least = criterion;
    best.coefficients = a;
    best.innovation = innovation;
  }
  return best;
}

double calc_autocorrelation_time(const Autoregression& model) {
  if (!(model.variance > 0.0)) return 1.0;
  const double gain = 1.0 - std::accumulate(model.coefficients.begin(), model.coefficients.end(), 0.0);
  const double time = model.innovation / (gain * gain * model.variance);
  return std::isfinite(time) ? time : std::numeric_limits<double>::max();  // a series that does not vary
}

}  // namespace jobs
