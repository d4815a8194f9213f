// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/time_left.h"

#include <algorithm>
#include <cmath>

namespace jobs {
namespace {

/// Variance of the wall time a simulated second.
double calc_rate_variance(const CostOfKind& cost, double rate) {
  if (cost.computed < 2) return rate * rate;
  const auto n = static_cast<double>(cost.computed);
  return std::max(0.0, (cost.rate_squares - cost.rates * cost.rates / n) / (n - 1.0));
}

}  // namespace

std::optional<TimeLeft> estimate_time_left(const SweepRow& row, int threads) {
  if (has_ended(row.counts)) return TimeLeft{};
  // By passing time: the solvers give way to other programs, so that their CPU time says too little.
  double thread_time_s = 0.0;
  double variance_s2 = 0.0;
  double longest_s = 0.0;
  for (const auto& [kind, cost] : row.costs) {
    const std::size_t running = cost.running.size();
    if (cost.queued == 0 && running == 0) continue;
    if (cost.computed == 0 || !(cost.computed_s > 0.0)) return std::nullopt;
    const double rate = cost.wall_time_s / cost.computed_s;
    double left_squares_s2 = cost.queued_squares_s2;
    thread_time_s += rate * cost.queued_s;
    longest_s = std::max(longest_s, rate * cost.longest_queued_s);
    for (const RunningCost& job : cost.running) {
      // A job that takes longer than expected is expected to take as much longer again.
      const double left_s = std::abs(rate * job.simulated_s - job.elapsed_s);
      thread_time_s += left_s;
      longest_s = std::max(longest_s, left_s);
      left_squares_s2 += job.simulated_s * job.simulated_s;
    }
    const double left = static_cast<double>(cost.queued) + static_cast<double>(running);
    variance_s2 += calc_rate_variance(cost, rate) * left_squares_s2 *
                   (1.0 + left / static_cast<double>(cost.computed));
  }
  const double spread_s = 2.0 * std::sqrt(variance_s2) / threads;
  const double expected_s = std::max(longest_s, thread_time_s / threads);
  return TimeLeft{.expected_s = expected_s, .low_s = std::max(0.0, expected_s - spread_s),
                  .high_s = expected_s + spread_s};
}

}  // namespace jobs
