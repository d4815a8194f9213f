// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/time_left.h"

#include <algorithm>
#include <cmath>

namespace jobs {
namespace {

double calc_variance_s2(const CostOfKind& cost, double mean_s) {
  if (cost.computed < 2) return mean_s * mean_s;
  const auto n = static_cast<double>(cost.computed);
  return std::max(0.0, (cost.wall_time_squares_s2 - n * mean_s * mean_s) / (n - 1.0));
}

}  // namespace

std::optional<TimeLeft> estimate_time_left(const SweepRow& row, int threads) {
  if (has_ended(row.counts)) return TimeLeft{};
  // By passing time: the solvers give way to other programs, so that their CPU time says too little.
  double thread_time_s = 0.0;
  double variance_s2 = 0.0;
  double longest_s = 0.0;
  for (const auto& [kind, cost] : row.costs) {
    if (cost.queued + cost.running == 0) continue;
    if (cost.computed == 0) return std::nullopt;
    const double mean_s = cost.wall_time_s / static_cast<double>(cost.computed);
    const double left = static_cast<double>(cost.queued) + 0.5 * static_cast<double>(cost.running);
    thread_time_s += mean_s * left;
    variance_s2 += calc_variance_s2(cost, mean_s) * left * (1.0 + left / static_cast<double>(cost.computed));
    longest_s = std::max(longest_s, cost.queued > 0 ? mean_s : 0.5 * mean_s);
  }
  const double spread_s = 2.0 * std::sqrt(variance_s2) / threads;
  const double expected_s = std::max(longest_s, thread_time_s / threads);
  return TimeLeft{.expected_s = expected_s, .low_s = std::max(0.0, expected_s - spread_s),
                  .high_s = expected_s + spread_s};
}

}  // namespace jobs
