// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/plan_budget.h"

#include <string>

#include "jobs/base/content_id.h"
#include "jobs/base/errors.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/linkages/linkage_size.h"

namespace jobs {
namespace {

constexpr double kWorkOfAJob = 3.0;
constexpr double kBytesOfAJob = 10'000.0;

[[noreturn]] void refuse(std::uint64_t jobs, const char* reason, double left) {
  throw InvalidRequest(
      std::vector<Fault>{{"", "the linkage is too large for a sweep of " + std::to_string(jobs) + " jobs, " +
                                  reason + ": at most " + std::to_string(static_cast<std::uint64_t>(left)) +
                                  " are allowed; submit several sweeps"}});
}

}  // namespace

PlanBudget::PlanBudget(std::size_t max_jobs)
    : work_(kWorkOfAJob * static_cast<double>(max_jobs)),
      bytes_(kBytesOfAJob * static_cast<double>(max_jobs)) {}

void PlanBudget::take(const nlohmann::json& completed, std::uint64_t points, std::uint64_t replicates) {
  if (!describes_linkage(completed)) return;
  const auto jobs = points * replicates;
  const double work = calc_closing_work(
      size_of_linkage(completed.at(kLinkageKey), completed.at("rigid_elements").get<std::size_t>()));
  if (work * static_cast<double>(points) > work_)
    refuse(jobs, "whose loops would all have to be closed", work_ / work * static_cast<double>(replicates));
  const auto bytes = static_cast<double>(canonical_text(completed).size());
  if (bytes * static_cast<double>(jobs) > bytes_)
    refuse(jobs, "each of which keeps its description", bytes_ / bytes);
  work_ -= work * static_cast<double>(points);
  bytes_ -= bytes * static_cast<double>(jobs);
}

}  // namespace jobs
