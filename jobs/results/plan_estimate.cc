// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/plan_estimate.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "jobs/parameters/kept_results.h"

namespace jobs {
namespace {

using nlohmann::json;

/// Sums over the jobs that are to be computed.
struct NewJobs {
  std::size_t jobs = 0;
  double seconds = 0.0;  ///< on one thread
  double longest_s = 0.0;
  double bytes = 0.0;
  std::set<std::string> measured, unmeasured;  ///< kinds

  void add(const PlannedJob& job, const KindCost& cost) {
    ++jobs;
    if (cost.measured == 0 || cost.simulated_s <= 0.0) {
      unmeasured.insert(job.kind);
      return;
    }
    measured.insert(job.kind);
    const json parameters = json::parse(job.parameters);
    const double duration = parameters.at("duration_s");
    const double takes = duration * cost.seconds / cost.simulated_s;
    seconds += takes;
    longest_s = std::max(longest_s, takes);
    bytes += cost.other_bytes / static_cast<double>(cost.measured);
    if (parameters.value(kKeepKey, std::string(kKeepAll)) != kKeepAll || cost.samples <= 0.0) return;
    bytes += duration * parameters.at("output_rate_hz").get<double>() * cost.trajectory_bytes / cost.samples;
  }
};

NewJobs sum_new_jobs(const SweepPlan& plan, const PlanCosts& costs) {
  NewJobs sums;
  std::set<std::string_view> planned;  // equal jobs are computed once
  for (const PlannedJob& job : plan.jobs) {
    if (costs.stored.contains(job.content_id)) continue;
    if (plan.reuse && !planned.insert(job.content_id).second) continue;
    sums.add(job, costs.kinds.at(job.kind));
  }
  return sums;
}

}  // namespace

json plan_estimate_json(const SweepPlan& plan, const PlanCosts& costs, int threads) {
  const NewJobs estimate = sum_new_jobs(plan, costs);
  std::int64_t measured = 0;
  for (const std::string& kind : estimate.measured) measured += costs.kinds.at(kind).measured;
  const bool known = estimate.unmeasured.empty();
  const double wall = std::max(estimate.seconds / threads, estimate.longest_s);
  return {{"jobs", plan.jobs.size()},
          {"stored_jobs", plan.jobs.size() - estimate.jobs},
          {"new_jobs", estimate.jobs},
          {"seconds", known ? json(wall) : json()},
          {"bytes", known ? json(estimate.bytes) : json()},
          {"measured_jobs", measured},
          {"unmeasured_kinds", estimate.unmeasured}};
}

}  // namespace jobs
