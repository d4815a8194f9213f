#include "jobs/search/study_desk.h"

#include <limits>
#include <utility>

#include "jobs/extend_request.h"
#include "jobs/ids.h"
#include "jobs/page.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();  // of a request that has been taken

}  // namespace

std::optional<SearchRow> StudyDesk::find_row(const std::string& id) const {
  return is_id(id, kind_->id_prefix()) ? store_.find_search(id) : std::nullopt;
}

json StudyDesk::submit(const ordered_json& request) {
  const FirstSweep first = kind_->plan_first(request, options_.max_sweep_jobs);
  return find(store_.add_search(kind_->id_prefix(), first.plan, first.request.dump(), request.dump(), options_.max_queued_jobs)).value();
}

std::optional<json> StudyDesk::find(const std::string& id) const {
  const auto row = find_row(id);
  if (!row) return std::nullopt;
  const auto results = store_.find_results(row->sweep_id, false);
  return results ? std::optional(kind_->make_resource(*row, *results, options_.threads)) : std::nullopt;
}

json StudyDesk::list(const PageQuery& query) const {
  const PageChecker checker(query, kind_->id_prefix(), kind_->listing_keys(), kSearchStates);
  return make_page(store_.list_searches(kind_->id_prefix(), query.state, query.cursor, query.limit + 1), query.limit, checker,
                   [this](const SearchRow& row) { return kind_->make_summary(row); });
}

std::optional<ResultTable> StudyDesk::find_table(const std::string& id) const {
  const auto row = find_row(id);
  if (!row) return std::nullopt;
  const auto results = store_.find_results(row->sweep_id, false);
  return results ? std::optional(kind_->make_table(*row, *results)) : std::nullopt;
}

bool StudyDesk::cancel(const std::string& id, const std::function<void(const std::string&)>& cancel_sweep) {
  const std::lock_guard lock(moving_);
  const auto row = find_row(id);
  if (!row) return false;
  if (row->state != "running" && row->state != "cancelled") throw WrongState("the study has ended");
  store_.set_search_state(id, "running", "cancelled");
  cancel_sweep(row->sweep_id);
  return true;
}

bool StudyDesk::retry(const std::string& id, const std::function<void(const std::string&)>& retry_sweep) {
  const std::lock_guard lock(moving_);
  const auto row = find_row(id);
  if (!row) return false;
  if (row->state == "running") return true;
  retry_sweep(row->sweep_id);
  store_.reopen_search_of(row->sweep_id);
  return true;
}

std::optional<std::string> StudyDesk::find_ended_sweep(const std::string& id) const {
  const auto row = find_row(id);
  if (!row) return std::nullopt;
  if (row->state == "running") throw WrongState("the study has not ended; cancel it first");
  return row->sweep_id;
}

bool StudyDesk::advance() {
  const std::lock_guard lock(moving_);
  bool any = false;
  for (const SearchRow& study : store_.list_searches(kind_->id_prefix(), "running", "", kNoLimit >> 1U)) {
    // What is added may be known already, and ask for more at once.
    while (advance(study)) any = true;
  }
  return any;
}

bool StudyDesk::advance(const SearchRow& row) {
  const auto results = store_.find_results(row.sweep_id, false);
  if (!results) return false;  // it has been deleted
  try {
    const StudyStep step = kind_->find_step(row, *results);
    if (step.end_state) {
      store_.set_search_state(row.id, "running", *step.end_state, step.error);
      return false;
    }
    if (step.cases.empty()) return false;
    const auto former = ordered_json::parse(results->sweep.request);
    const Extension extension = plan_extension(former, {{"cases", step.cases}}, kNoLimit);
    if (extension.jobs.empty()) throw InvalidRequest(std::vector<Fault>{{"", "its sweep has what is needed next, but not as its own jobs"}});
    return store_.extend_sweep(row.sweep_id, results->sweep.request, extension.request.dump(), extension.jobs, kNoLimit);
  } catch (const InvalidRequest& invalid) {  // what lies between two values may be no linkage, though both are
    store_.set_search_state(row.id, "running", "failed", invalid.what());
    return false;
  }
}

}  // namespace jobs
