#include "jobs/search/search_desk.h"

#include <limits>
#include <utility>

#include "jobs/extend_request.h"
#include "jobs/ids.h"
#include "jobs/page.h"
#include "jobs/search/search_picture.h"
#include "jobs/search/search_request.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();  // of a request that has been taken

SearchRequest request_of(const SearchRow& row) { return parse_search_request(ordered_json::parse(row.request), kNoLimit); }

/// The cases that a search asks for next.
ordered_json next_cases(const SearchRequest& search, const SearchPicture& picture) {
  ordered_json cases = ordered_json::array();
  for (const CombinationPicture& combination : picture.combinations) {
    for (const double x : combination.limit.next) cases.push_back(case_at(search, combination.values, x));
  }
  return cases;
}

}  // namespace

json SearchDesk::submit(const ordered_json& request) {
  const SearchRequest search = parse_search_request(request, options_.max_sweep_jobs);
  const ordered_json sweep = first_sweep_of(request, search);
  const SweepPlan plan = plan_first_sweep(sweep, search, options_.max_sweep_jobs);
  return find(store_.add_search(plan, sweep.dump(), request.dump(), options_.max_queued_jobs)).value();
}

std::optional<json> SearchDesk::find(const std::string& id) const {
  const auto row = store_.find_search(id);
  if (!row) return std::nullopt;
  const auto results = store_.find_results(row->sweep_id, false);
  return results ? std::optional(search_json(*row, request_of(*row), *results, options_.threads)) : std::nullopt;
}

json SearchDesk::list(const PageQuery& query) const {
  const PageChecker checker(query, kSearchPrefix, search_listing_keys(), kSearchStates);
  return make_page(store_.list_searches(query.state, query.cursor, query.limit + 1), query.limit, checker, search_summary_json);
}

std::optional<ResultTable> SearchDesk::find_limits(const std::string& id) const {
  const auto row = store_.find_search(id);
  if (!row) return std::nullopt;
  const auto results = store_.find_results(row->sweep_id, false);
  return results ? std::optional(limit_table(*row, request_of(*row), *results)) : std::nullopt;
}

bool SearchDesk::cancel(const std::string& id, const std::function<void(const std::string&)>& cancel_sweep) {
  const std::lock_guard lock(moving_);
  const auto row = store_.find_search(id);
  if (!row) return false;
  if (row->state != "running" && row->state != "cancelled") throw WrongState("the search has ended");
  store_.set_search_state(id, "running", "cancelled");
  cancel_sweep(row->sweep_id);
  return true;
}

bool SearchDesk::retry(const std::string& id, const std::function<void(const std::string&)>& retry_sweep) {
  const std::lock_guard lock(moving_);
  const auto row = store_.find_search(id);
  if (!row) return false;
  if (row->state == "running") return true;
  retry_sweep(row->sweep_id);
  store_.reopen_search_of(row->sweep_id);
  return true;
}

bool SearchDesk::advance() {
  const std::lock_guard lock(moving_);
  bool any = false;
  for (const SearchRow& search : store_.list_searches("running", "", kNoLimit >> 1U)) {
    // What is added may be known already, and ask for more at once.
    while (advance(search)) any = true;
  }
  return any;
}

bool SearchDesk::advance(const SearchRow& row) {
  const auto results = store_.find_results(row.sweep_id, false);
  if (!results) return false;  // it has been deleted
  const SearchRequest search = request_of(row);
  const SearchPicture picture = make_picture(search, *results);
  if (picture.has_ended()) {
    store_.set_search_state(row.id, "running", picture.end_state());
    return false;
  }
  const ordered_json cases = next_cases(search, picture);
  if (cases.empty()) return false;
  try {
    const auto former = ordered_json::parse(results->sweep.request);
    const Extension extension = plan_extension(former, {{"cases", cases}}, kNoLimit);
    if (extension.jobs.empty()) throw InvalidRequest(std::vector<Fault>{{"", "its sweep has what is needed next, but not as its own jobs"}});
    return store_.extend_sweep(row.sweep_id, results->sweep.request, extension.request.dump(), extension.jobs, kNoLimit);
  } catch (const InvalidRequest& invalid) {  // what lies between two values may be no linkage, though both are
    store_.set_search_state(row.id, "running", "failed", invalid.what());
    return false;
  }
}

}  // namespace jobs
