#include "jobs/search/limit_study.h"

#include <limits>
#include <utility>

#include "jobs/ids.h"
#include "jobs/search/search_picture.h"
#include "jobs/search/search_request.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

SearchRequest request_of(const SearchRow& row) {
  return parse_search_request(ordered_json::parse(row.request), std::numeric_limits<std::size_t>::max());
}

class LimitStudy final : public StudyKind {
 public:
  [[nodiscard]] std::string_view id_prefix() const override { return kSearchPrefix; }

  [[nodiscard]] FirstSweep plan_first(const ordered_json& request, std::size_t max_jobs) const override {
    const SearchRequest search = parse_search_request(request, max_jobs);
    ordered_json sweep = first_sweep_of(request, search);
    SweepPlan plan = plan_first_sweep(sweep, search, max_jobs);
    return {std::move(sweep), std::move(plan)};
  }

  [[nodiscard]] StudyStep find_step(const SearchRow& row, const SweepResults& results) const override {
    const SearchRequest search = request_of(row);
    const SearchPicture picture = make_picture(search, results);
    StudyStep step;
    if (picture.has_ended()) step.end_state = picture.end_state();
    for (const CombinationPicture& combination : picture.combinations) {
      for (const double x : combination.limit.next) step.cases.push_back(case_at(search, combination.values, x));
    }
    return step;
  }

  [[nodiscard]] json make_resource(const SearchRow& row, const SweepResults& results, int threads) const override {
    return search_json(row, request_of(row), results, threads);
  }
  [[nodiscard]] json make_summary(const SearchRow& row) const override { return search_summary_json(row); }
  [[nodiscard]] const std::vector<std::string>& listing_keys() const override { return search_listing_keys(); }
  [[nodiscard]] ResultTable make_table(const SearchRow& row, const SweepResults& results) const override {
    return limit_table(row, request_of(row), results);
  }
};

}  // namespace

std::unique_ptr<StudyKind> make_limit_study() { return std::make_unique<LimitStudy>(); }

}  // namespace jobs
