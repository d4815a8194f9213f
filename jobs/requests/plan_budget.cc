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
constexpr double kBytesOfAJob = 5'000.0;  // those of default parameters are 2,000

[[noreturn]] void refuse(const std::string& what, std::uint64_t jobs, const char* reason, double left) {
  throw InvalidRequest(
      std::vector<Fault>{{"", what + " too large for a sweep of " + std::to_string(jobs) + " jobs, " +
                                  reason + ": at most " + std::to_string(static_cast<std::uint64_t>(left)) +
                                  " are allowed; submit several sweeps"}});
}

}  // namespace

PlanBudget::PlanBudget(std::size_t max_jobs)
    : work_(kWorkOfAJob * static_cast<double>(max_jobs)),
      bytes_(kBytesOfAJob * static_cast<double>(max_jobs)),
      bytes_of_jobs_(bytes_) {}

void PlanBudget::take_closing_work(const nlohmann::json& completed, std::uint64_t points,
                                   std::uint64_t replicates) {
  const double work = calc_closing_work(
      size_of_linkage(completed.at(kLinkageKey), completed.at("rigid_elements").get<std::size_t>()));
  if (work * static_cast<double>(points) > work_)
    refuse("the linkage is", points * replicates, "whose loops would all have to be closed",
           work_ / work * static_cast<double>(replicates));
  work_ -= work * static_cast<double>(points);
}

void PlanBudget::take(const nlohmann::json& completed, std::uint64_t points, std::uint64_t replicates) {
  const auto jobs = points * replicates;
  const bool is_described = describes_linkage(completed);
  if (is_described) take_closing_work(completed, points, replicates);
  const auto bytes = static_cast<double>(canonical_text(completed).size());
  if (bytes * static_cast<double>(jobs) > bytes_) {
    if (is_described) refuse("the linkage is", jobs, "each of which keeps its description", bytes_ / bytes);
    refuse("the parameters are", jobs, "each of which keeps them", bytes_ / bytes);
  }
  bytes_ -= bytes * static_cast<double>(jobs);
}

void PlanBudget::add_job(std::size_t bytes) {
  bytes_of_jobs_ -= static_cast<double>(bytes);
  if (bytes_of_jobs_ < 0.0)
    refuse("the parameters are", jobs_ + 1, "or more, each of which keeps them", static_cast<double>(jobs_));
  ++jobs_;
}

}  // namespace jobs
