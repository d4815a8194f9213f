// SPDX-License-Identifier: Apache-2.0
#include "jobs/search/limit_study.h"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "jobs/base/ids.h"
#include "jobs/search/search_picture.h"
#include "jobs/search/search_request.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

SearchRequest search_of(const SearchRow& row) {
  return parse_search_request(ordered_json::parse(row.request), std::numeric_limits<std::size_t>::max());
}

/// What a search's jobs have shown. Looks only at combinations that wait for nothing.
class LimitCourse final : public StudyCourse {
 public:
  LimitCourse(SearchRequest search, const SweepResults& results)
      : search_(std::move(search)), tally_(search_, results.sweep), open_(tally_.picture.combinations.size()) {
    for (const ResultRow& job : results.rows) tally_.add(job);
    for (std::size_t k = 0; k < tally_.picture.combinations.size(); ++k) note(k);
  }

  void take(const ResultRow& ended) override {
    if (const auto combination = tally_.end(ended)) note(*combination);
  }

  [[nodiscard]] StudyStep find_step() override {
    StudyStep step;
    for (const std::size_t k : std::exchange(ready_, {})) {
      CombinationPicture& combination = tally_.picture.combinations[k];
      combination.limit = find_limit(search_.path, search_.rule, combination.evaluations);
      if (combination.limit.verdict != Verdict::kOpen) --open_;
      for (const double x : combination.limit.next) {
        step.cases.push_back(case_at(search_, combination.values, x));
        tally_.expect(k, x);
      }
    }
    if (open_ == 0) step.end_state = tally_.picture.end_state();
    return step;
  }

  [[nodiscard]] double progress() const override { return calc_progress(tally_.picture, search_); }

 private:
  void note(std::size_t combination) {
    if (tally_.picture.combinations[combination].pending == 0) ready_.push_back(combination);
  }

  const SearchRequest search_;
  SearchTally tally_;
  std::size_t open_;                 ///< combinations without a verdict
  std::vector<std::size_t> ready_;   ///< combinations whose jobs have all ended since they were looked at
};

class LimitStudy final : public StudyKind {
 public:
  [[nodiscard]] std::string_view id_prefix() const override { return kSearchPrefix; }

  [[nodiscard]] FirstSweep plan_first(const ordered_json& request, std::size_t max_jobs) const override {
    const SearchRequest search = parse_search_request(request, max_jobs);
    ordered_json sweep = first_sweep_of(request, search);
    SweepPlan plan = plan_first_sweep(sweep, search, max_jobs);
    return {std::move(sweep), std::move(plan)};
  }

  [[nodiscard]] std::unique_ptr<StudyCourse> make_course(const SearchRow& row, const SweepResults& results) const override {
    return std::make_unique<LimitCourse>(search_of(row), results);
  }

  [[nodiscard]] json make_resource(const SearchRow& row, const SweepResults& results, int threads) const override {
    return search_json(row, search_of(row), results, threads);
  }
  [[nodiscard]] json make_summary(const SearchRow& row) const override { return search_summary_json(row); }
  [[nodiscard]] const std::vector<std::string>& listing_keys() const override { return search_listing_keys(); }
  [[nodiscard]] ResultTable make_table(const SearchRow& row, const SweepResults& results) const override {
    return limit_table(row, search_of(row), results);
  }
};

}  // namespace

std::unique_ptr<StudyKind> make_limit_study() { return std::make_unique<LimitStudy>(); }

}  // namespace jobs
