// SPDX-License-Identifier: Apache-2.0
#include "jobs/studies/study_desk.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "jobs/base/ids.h"
#include "jobs/results/page.h"
#include "jobs/results/resource_json.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();  // of a request that has been taken

}  // namespace

std::optional<SearchRow> StudyDesk::find_row(const std::string& id) const {
  return is_id(id, kind_->id_prefix()) ? store_.find_search(id) : std::nullopt;
}

json StudyDesk::submit(const ordered_json& request, const KeptText& kept) {
  const FirstSweep first = kind_->plan_first(request, room_.max_sweep_jobs);
  const KeptAnswer<StudyRow> answer{.key = kept.key, .request = kept.request, .make_text = [&](StudyRow begun) {
                                      // As it begins: what jobs show that were computed before has not been looked at.
                                      for (ResultRow& job : begun.results.rows) job.state = state_name(JobState::kQueued);
                                      return *kept.answer = text_of(kind_->make_resource(begun.search, begun.results, room_.threads));
                                    }};
  const std::string id = store_.add_search(kind_->id_prefix(), first.plan, first.request.dump(), request.dump(), room_.max_queued_jobs, answer);
  ++begun_;
  return find(id).value();
}

std::optional<json> StudyDesk::find(const std::string& id) const {
  const auto row = find_row(id);
  if (!row) return std::nullopt;
  const auto results = store_.find_results(row->sweep_id, false);
  return results ? std::optional(kind_->make_resource(*row, *results, room_.threads)) : std::nullopt;
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
  under_way_.erase(id);
  cancel_sweep(row->sweep_id);
  return true;
}

bool StudyDesk::retry(const std::string& id, const std::function<void(const std::string&)>& retry_sweep) {
  const std::lock_guard lock(moving_);
  const auto row = find_row(id);
  if (!row) return false;
  if (row->state == "running") return true;
  under_way_.erase(id);
  retry_sweep(row->sweep_id);
  ++begun_;
  return true;
}

std::optional<std::string> StudyDesk::find_ended_sweep(const std::string& id) const {
  const auto row = find_row(id);
  if (!row) return std::nullopt;
  if (row->state == "running") throw WrongState("the study has not ended; cancel it first");
  return row->sweep_id;
}

void StudyDesk::change_sweep(const std::string& sweep_id, const std::function<void()>& change) {
  const std::lock_guard lock(moving_);
  std::erase_if(under_way_, [&](const auto& study) { return study.second.sweep_id == sweep_id; });
  change();
  ++begun_;
}

StudyMoves StudyDesk::advance() {
  const std::lock_guard lock(moving_);
  const std::uint64_t begun = begun_;
  if (idle_since_ == begun) return {};  // most services have no study, and are not to ask the store for them after each job
  const auto running = store_.list_searches(kind_->id_prefix(), "running", "", kNoLimit >> 1U);
  forget_ended(running);
  if (running.empty()) idle_since_ = begun;
  StudyMoves moves;
  for (const SearchRow& study : running) {
    for (bool goes_on = true; goes_on;) {  // what is added may be known already, and ask for more at once
      const StudyMoves one = advance(study);
      moves.any |= one.any;
      moves.added |= one.added;
      goes_on = one.added;
    }
  }
  return moves;
}

void StudyDesk::forget_ended(const std::vector<SearchRow>& running) {
  const auto has_ended = [&](const auto& study) { return std::ranges::find(running, study.first, &SearchRow::id) == running.end(); };
  std::erase_if(under_way_, has_ended);
  const std::lock_guard lock(progress_mutex_);
  std::erase_if(progress_, has_ended);
}

StudyMoves StudyDesk::advance(const SearchRow& study) {
  try {
    return look_at(study) ? take_step(study) : StudyMoves{};
  } catch (const InvalidRequest& invalid) {  // what lies between two values may be no linkage, though both are
    store_.set_search_state(study.id, "running", "failed", invalid.what());
    under_way_.erase(study.id);
    return {.any = true};
  } catch (...) {  // it is looked at from its beginning the next time
    under_way_.erase(study.id);
    throw;
  }
}

bool StudyDesk::look_at(const SearchRow& study) {
  const auto known = under_way_.find(study.id);
  const auto ended = known == under_way_.end() ? std::vector<ResultRow>{} : store_.find_ended(study.sweep_id, known->second.change);
  if (known == under_way_.end()) {
    const auto results = store_.find_results(study.sweep_id, false);
    if (!results) return false;  // it has been deleted
    UnderWay begun{.sweep_id = study.sweep_id, .common = ordered_json::parse(results->sweep.request), .course = kind_->make_course(study, *results)};
    begun.common.erase("cases");
    for (const ResultRow& job : results->rows) begun.change = std::max(begun.change, job.change);
    under_way_.emplace(study.id, std::move(begun));
    return true;
  }
  for (const ResultRow& job : ended) known->second.course->take(job);
  if (!ended.empty()) known->second.change = ended.back().change;
  return !ended.empty();
}

StudyMoves StudyDesk::take_step(const SearchRow& study) {
  UnderWay& known = under_way_.at(study.id);
  const StudyStep step = known.course->find_step();
  {
    const std::lock_guard lock(progress_mutex_);
    progress_[study.id] = known.course->progress();
  }
  if (step.end_state) {
    store_.set_search_state(study.id, "running", *step.end_state, step.error);
    return {.any = true};
  }
  if (step.cases.empty()) return {.any = true};
  ordered_json request = known.common;
  request["cases"] = step.cases;
  const bool added = store_.add_cases(study.sweep_id, step.cases, plan_sweep(request, kNoLimit).jobs);
  return {.any = true, .added = added};
}

double StudyDesk::find_progress(const std::string& id) const {
  const std::lock_guard lock(progress_mutex_);
  const auto known = progress_.find(id);
  return known == progress_.end() ? 0.0 : known->second;
}

}  // namespace jobs
