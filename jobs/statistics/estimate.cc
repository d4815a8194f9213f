// SPDX-License-Identifier: Apache-2.0
#include "jobs/statistics/estimate.h"

#include <cmath>

#include <boost/math/distributions/students_t.hpp>

#include "jobs/statistics/replicate_statistics.h"

namespace jobs {

Estimate estimate_mean(std::span<const double> values) {
  constexpr double kConfidence = 0.95;
  const ReplicateStatistics statistics = calc_replicate_statistics(values);
  const auto n = static_cast<double>(statistics.count);
  const double reach = boost::math::quantile(boost::math::students_t(n - 1.0), 0.5 * (1.0 + kConfidence)) *
                       *statistics.spread / std::sqrt(n);
  return {*statistics.mean, *statistics.mean - reach, *statistics.mean + reach};
}

}  // namespace jobs
