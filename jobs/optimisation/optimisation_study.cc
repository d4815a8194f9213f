// SPDX-License-Identifier: Apache-2.0
#include "jobs/optimisation/optimisation_study.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/base/ids.h"
#include "jobs/optimisation/optimisation_json.h"
#include "jobs/optimisation/optimisation_request.h"
#include "jobs/optimisation/optimiser.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/parameter_path.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

Optimiser optimiser_of(const StudyRow& row, const SweepResults& results) {
  const ordered_json request = ordered_json::parse(row.request);
  return {parse_optimisation_request(request, std::numeric_limits<std::size_t>::max()),
          common_sweep_of(request), &results};
}

/// Faults of cases as faults of the variables that gave them their values.
InvalidRequest invalid_request_of(const InvalidRequest& invalid) {
  std::vector<Fault> faults;
  std::set<std::string> told;
  for (Fault fault : invalid.faults()) {
    if (fault.pointer.starts_with("/cases/")) {
      const std::string path = path_in_case(fault.pointer);
      fault.pointer = "/over" + (path.empty() ? "" : pointer_token(path));
    }
    if (told.insert(fault.pointer + fault.detail).second) faults.push_back(std::move(fault));
  }
  return InvalidRequest(std::move(faults));
}

class OptimisationStudy final : public StudyType {
 public:
  [[nodiscard]] std::string_view id_prefix() const override { return kOptimisationPrefix; }

  [[nodiscard]] FirstSweep plan_first(const ordered_json& request, std::size_t max_jobs) const override {
    ordered_json sweep = common_sweep_of(request);
    Optimiser optimiser(parse_optimisation_request(request, max_jobs), sweep, nullptr);
    NextCases first = optimiser.ask();
    if (first.cases.empty()) throw invalid_request_of(optimiser.first_invalid().value());
    sweep["cases"] = std::move(first.cases);
    SweepPlan plan = plan_sweep(sweep, max_jobs);
    return {std::move(sweep), std::move(plan)};
  }

  [[nodiscard]] std::unique_ptr<StudySampler> make_sampler(const StudyRow& row,
                                                           const SweepResults& results) const override {
    return std::make_unique<Optimiser>(optimiser_of(row, results));
  }

  [[nodiscard]] json make_resource(const StudyRow& row, const SweepResults& results,
                                   int threads) const override {
    return optimisation_json(row, asked(row, results), results, threads);
  }
  [[nodiscard]] json make_summary(const StudyRow& row) const override {
    return optimisation_summary_json(row);
  }
  [[nodiscard]] const std::vector<std::string>& listing_keys() const override {
    return optimisation_listing_keys();
  }
  [[nodiscard]] ResultTable make_table(const StudyRow& row, const SweepResults& results) const override {
    return candidate_table(row, asked(row, results));
  }

 private:
  /// The searches of the starts as far as the results take them.
  static Optimiser asked(const StudyRow& row, const SweepResults& results) {
    Optimiser optimiser = optimiser_of(row, results);
    (void)optimiser.ask();
    return optimiser;
  }
};

}  // namespace

std::unique_ptr<StudyType> make_optimisation_study() { return std::make_unique<OptimisationStudy>(); }

}  // namespace jobs
