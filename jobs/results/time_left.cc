// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/time_left.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

namespace jobs {
namespace {

/// Cost of a simulated second of a kind, and how well it is known.
struct Rate {
  double mean = 0.0;
  double variance = 0.0;    ///< of one job's
  double samples = 1.0;
};

/// The rate of jobs of which some are computed.
Rate calc_rate(const CostOfKind& cost) {
  const auto n = static_cast<double>(cost.computed);
  double wall_time_s = cost.wall_time_s, computed_s = cost.computed_s;
  for (const RunningCost& job : cost.running) {
    if (job.part_done) wall_time_s += job.elapsed_s;
    computed_s += job.part_done.value_or(0.0) * job.simulated_s;
  }
  const double mean = wall_time_s / computed_s;
  const double variance =
      cost.computed < 2 ? mean * mean
                        : std::max(0.0, (cost.rate_squares - cost.rates * cost.rates / n) / (n - 1.0));
  return {.mean = mean, .variance = variance, .samples = n};
}

std::optional<Rate> find_rate(const std::string& kind, const CostOfKind& cost, double unit_s,
                              const std::map<std::string, double>& usual) {
  if (cost.computed > 0 && cost.computed_s > 0.0) return calc_rate(cost);
  const auto found = usual.find(kind);
  if (found == usual.end()) return std::nullopt;
  const double mean = found->second * unit_s;
  return Rate{.mean = mean, .variance = mean * mean};
}

/// Time on one thread.
struct Work {
  double expected_s = 0.0, variance_s2 = 0.0;
  double longest_s = 0.0;   ///< of its jobs

  /// @param weight  number of the like of it
  void add(const Work& other, double weight) {
    expected_s += weight * other.expected_s;
    variance_s2 += weight * other.variance_s2;
  }
};

/// A job that takes longer than expected is expected to take as much longer again.
double calc_left_s(const RunningCost& job, const Rate& rate) {
  const double expected_s = rate.mean * job.simulated_s;
  return job.part_done ? (1.0 - *job.part_done) * expected_s : std::abs(expected_s - job.elapsed_s);
}

/// Adds the jobs of one kind. @param waiting  part of the queued ones that counts
void add_kind(const CostOfKind& cost, const Rate& rate, double waiting, Work& work) {
  const double queued = waiting * static_cast<double>(cost.queued);
  double left_squares_s2 = waiting * cost.queued_squares_s2;
  work.expected_s += rate.mean * waiting * cost.queued_s;
  if (queued > 0.0) work.longest_s = std::max(work.longest_s, rate.mean * cost.longest_queued_s);
  for (const RunningCost& job : cost.running) {
    const double left_s = calc_left_s(job, rate);
    work.expected_s += left_s;
    work.longest_s = std::max(work.longest_s, left_s);
    left_squares_s2 += job.simulated_s * job.simulated_s;
  }
  const double left = queued + static_cast<double>(cost.running.size());
  work.variance_s2 += rate.variance * left_squares_s2 * (1.0 + left / rate.samples);
}

/// By passing time: the solvers give way to other programs, so that their CPU time says too little.
/// @param waiting  part of the queued jobs that counts
std::optional<Work> calc_work(const Costs& costs, double waiting, double unit_s,
                              const std::map<std::string, double>& usual) {
  Work work;
  for (const auto& [kind, cost] : costs) {
    if (waiting * static_cast<double>(cost.queued) == 0.0 && cost.running.empty()) continue;
    const auto rate = find_rate(kind, cost, unit_s, usual);
    if (!rate) return std::nullopt;
    add_kind(cost, *rate, waiting, work);
  }
  return work;
}

double count_queued(const Costs& costs) {
  std::int64_t queued = 0;
  for (const auto& [kind, cost] : costs) queued += cost.queued;
  return static_cast<double>(queued);
}

/// Part of a rival's queued jobs that are claimed before the last one of the sweep.
double part_before(const SweepRow& row, const RivalSweep& rival) {
  if (rival.priority != row.priority) return rival.priority > row.priority ? 1.0 : 0.0;
  const double queued = count_queued(rival.costs);
  return queued > 0.0 ? std::min(1.0, count_queued(row.costs) / queued) : 0.0;
}

/// Work of a sweep and of what its rivals have computed before its last job.
std::optional<Work> calc_work_with_rivals(const SweepRow& row, std::string_view default_executor) {
  const auto executor = [&](const std::string& name) { return name.empty() ? default_executor : name; };
  auto work = calc_work(row.costs, 1.0, row.unit_s, row.cost_rates);
  if (!work) return std::nullopt;
  for (const auto& rival : row.rivals) {
    if (count_queued(row.costs) == 0.0 || executor(rival->executor) != executor(row.executor)) continue;
    const auto before = calc_work(rival->costs, part_before(row, *rival), rival->unit_s, row.cost_rates);
    if (!before) return std::nullopt;
    work->add(*before, rival->weight);
  }
  return work;
}

}  // namespace

std::optional<TimeLeft> estimate_time_left(const SweepRow& row, int threads,
                                           std::string_view default_executor) {
  if (has_ended(row.counts)) return TimeLeft{};
  if (threads == 0) return std::nullopt;
  const auto work = calc_work_with_rivals(row, default_executor);
  if (!work) return std::nullopt;
  const double spread_s = 2.0 * std::sqrt(work->variance_s2) / threads;
  const double expected_s = std::max(work->longest_s, work->expected_s / threads);
  return TimeLeft{.expected_s = expected_s, .low_s = std::max(0.0, expected_s - spread_s),
                  .high_s = expected_s + spread_s};
}

}  // namespace jobs
