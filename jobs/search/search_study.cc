// SPDX-License-Identifier: Apache-2.0
#include "jobs/search/search_study.h"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "jobs/base/ids.h"
#include "jobs/requests/expand.h"
#include "jobs/search/search_json.h"
#include "jobs/search/search_request.h"
#include "jobs/search/search_results.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

SearchRequest search_of(const StudyRow& row) {
  return parse_search_request(ordered_json::parse(row.request), std::numeric_limits<std::size_t>::max());
}

/// Sampler of a search: computes limits only of combinations without pending jobs.
class LimitSampler final : public StudySampler {
 public:
  /// @param common  its sweep without cases
  LimitSampler(SearchRequest search, ordered_json common, const SweepResults& results)
      : search_(std::move(search)),
        common_(std::move(common)),
        results_(search_, results.sweep),
        open_(results_.combinations.size()) {
    for (const ResultRow& job : results.rows) results_.add(job);
    for (std::size_t k = 0; k < open_; ++k) add_if_ready(k);
  }

  void tell(const ResultRow& ended) override {
    if (const auto combination = results_.end(ended)) add_if_ready(*combination);
  }

  [[nodiscard]] NextCases ask() override {
    NextCases next;
    for (const std::size_t k : std::exchange(ready_, {})) {
      const std::vector<std::size_t> jobs = results_.judge(k, common_);
      const CombinationResults& combination = results_.combinations[k];
      if (combination.limit.verdict != Verdict::kOpen) --open_;
      for (std::size_t i = 0; i < jobs.size(); ++i) {
        const double x = combination.limit.next[i];
        next.cases.push_back(case_at(search_, combination.values, x));
        results_.expect(k, x, jobs[i]);
      }
    }
    if (open_ == 0 || (results_.cancelled && !results_.any_pending())) next.end_state = results_.end_state();
    return next;
  }

  [[nodiscard]] double progress() const override { return results_.calc_progress(); }

 private:
  void add_if_ready(std::size_t combination) {
    if (results_.combinations[combination].pending == 0) ready_.push_back(combination);
  }

  const SearchRequest search_;
  const ordered_json common_;
  SearchResults results_;
  std::size_t open_;                 ///< combinations without a verdict
  std::vector<std::size_t> ready_;   ///< combinations whose jobs have all ended since ask() evaluated them
};

class SearchStudy final : public StudyType {
 public:
  [[nodiscard]] std::string_view id_prefix() const override { return kSearchPrefix; }

  [[nodiscard]] FirstSweep plan_first(const ordered_json& request, std::size_t max_jobs) const override {
    const SearchRequest search = parse_search_request(request, max_jobs);
    ordered_json sweep = first_sweep_of(request, search);
    SweepPlan plan = plan_first_sweep(sweep, search, max_jobs);
    return {std::move(sweep), std::move(plan)};
  }

  [[nodiscard]] std::unique_ptr<StudySampler> make_sampler(const StudyRow& row,
                                                           const SweepResults& results) const override {
    return std::make_unique<LimitSampler>(search_of(row),
                                          common_sweep_of_search(ordered_json::parse(row.request)), results);
  }

  [[nodiscard]] json make_resource(const StudyRow& row, const SweepResults& results,
                                   int threads) const override {
    return search_json(row, search_of(row), results, threads);
  }
  [[nodiscard]] json make_summary(const StudyRow& row) const override { return search_summary_json(row); }
  [[nodiscard]] const std::vector<std::string>& listing_keys() const override {
    return search_listing_keys();
  }
  [[nodiscard]] ResultTable make_table(const StudyRow& row, const SweepResults& results) const override {
    return limit_table(row, search_of(row), results);
  }
};

}  // namespace

std::unique_ptr<StudyType> make_search_study() { return std::make_unique<SearchStudy>(); }

}  // namespace jobs
