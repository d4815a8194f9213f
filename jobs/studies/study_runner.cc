// SPDX-License-Identifier: Apache-2.0
#include "jobs/studies/study_runner.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

#include "jobs/base/ids.h"
#include "jobs/results/page.h"
#include "jobs/results/resource_json.h"
#include "jobs/store/store.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// For requests that have been accepted.
constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

}  // namespace

std::optional<StudyRow> StudyRunner::find_row(const std::string& id) const {
  return is_id(id, type_->id_prefix()) ? store_.studies.find(id) : std::nullopt;
}

json StudyRunner::submit(const ordered_json& request, const IdempotentRequest& idempotency) {
  const FirstSweep first = type_->plan_first(request, limits_.max_sweep_jobs);
  json response;
  const IdempotencyRecord<StudySnapshot> record{.key = idempotency.key,
                                                .fingerprint = idempotency.fingerprint,
                                                .make_response = [&](StudySnapshot begun) {
                                                  return text_of(response = make_response(std::move(begun)));
                                                }};
  store_.studies.add(type_->id_prefix(), first.plan, first.request.dump(), request.dump(),
                     limits_.max_queued_jobs, record, first.measurements);
  ++wakeups_;
  return response;
}

json StudyRunner::make_response(StudySnapshot begun) const {
  for (ResultRow& job : begun.results.rows) job.state = state_name(JobState::kQueued);
  return type_->make_resource(begun.study, begun.results, limits_.threads);
}

std::optional<json> StudyRunner::find(const std::string& id) const {
  const auto row = find_row(id);
  if (!row) return std::nullopt;
  const auto results = store_.reader.find_results(row->sweep_id);
  return results ? std::optional(type_->make_resource(*row, *results, limits_.threads)) : std::nullopt;
}

json StudyRunner::list(const PageQuery& query) const {
  const PageChecker checker(query, type_->id_prefix(), type_->listing_keys(), kStudyStates);
  return make_page(store_.studies.list(type_->id_prefix(), query.state, query.cursor, query.limit + 1),
                   query.limit, checker, [this](const StudyRow& row) { return type_->make_summary(row); });
}

std::optional<ResultTable> StudyRunner::find_table(const std::string& id) const {
  const auto row = find_row(id);
  if (!row) return std::nullopt;
  const auto results = store_.reader.find_results(row->sweep_id);
  return results ? std::optional(type_->make_table(*row, *results)) : std::nullopt;
}

std::optional<ResultTable> StudyRunner::find_signal_table(const std::string& id) const {
  const auto row = find_row(id);
  if (!row) return std::nullopt;
  const auto results = store_.reader.find_results(row->sweep_id);
  return results ? type_->make_signal_table(*row, *results) : std::nullopt;
}

bool StudyRunner::cancel(const std::string& id, const std::function<void()>& cancel_study) {
  const std::lock_guard lock(mutex_);
  const auto row = find_row(id);
  if (!row) return false;
  if (row->state != "running" && row->state != "cancelled") throw WrongState("the study has ended");
  cancel_study();
  active_.erase(id);
  return true;
}

bool StudyRunner::retry(const std::string& id, const std::function<void(const std::string&)>& retry_sweep) {
  const std::lock_guard lock(mutex_);
  const auto row = find_row(id);
  if (!row) return false;
  active_.erase(id);
  retry_sweep(row->sweep_id);
  ++wakeups_;
  return true;
}

std::optional<std::string> StudyRunner::find_ended_sweep(const std::string& id) const {
  const auto row = find_row(id);
  if (!row) return std::nullopt;
  if (row->state == "running") throw WrongState("the study has not ended; cancel it first");
  return row->sweep_id;
}

void StudyRunner::change_sweep(const std::string& sweep_id, const std::function<void()>& change) {
  const std::lock_guard lock(mutex_);
  std::erase_if(active_, [&](const auto& study) { return study.second.sweep_id == sweep_id; });
  change();
  ++wakeups_;
}

StudyChanges StudyRunner::advance() {
  const std::lock_guard lock(mutex_);
  const std::uint64_t wakeups = wakeups_;
  if (idle_wakeups_ == wakeups) return {};  // without a study, no query after each job
  const auto running = store_.studies.list(type_->id_prefix(), "running", "", kNoLimit >> 1U);
  forget_ended(running);
  if (running.empty()) idle_wakeups_ = wakeups;
  StudyChanges changes;
  for (const StudyRow& study : running) changes.add(advance_fully(study));
  return changes;
}

StudyChanges StudyRunner::advance_fully(const StudyRow& study) {
  StudyChanges changes;
  try {
    for (bool goes_on = true; goes_on;) {  // the results of added jobs may be known already
      const StudyChanges one = advance(study);
      changes.add(one);
      goes_on = one.added;
    }
  } catch (const std::exception&) {  // the store's errors, or no memory
    changes.failure = std::current_exception();
  }
  return changes;
}

void StudyRunner::forget_ended(const std::vector<StudyRow>& running) {
  const auto has_ended = [&](const auto& study) {
    return std::ranges::find(running, study.first, &StudyRow::id) == running.end();
  };
  std::erase_if(active_, has_ended);
  const std::lock_guard lock(progress_mutex_);
  std::erase_if(progress_, has_ended);
}

StudyChanges StudyRunner::advance(const StudyRow& study) {
  try {
    const auto active = active_.find(study.id);
    const bool is_new = active == active_.end() ? activate(study) : tell_ended_jobs(active->second);
    return is_new ? add_next_cases(study) : StudyChanges{};
  } catch (const InvalidRequest& invalid) {  // two values may be valid and one between them not
    store_.studies.set_state(study.id, "running", "failed", invalid.what());
    active_.erase(study.id);
    return {.any = true};
  } catch (...) {  // the next call reads all its jobs again
    active_.erase(study.id);
    throw;
  }
}

bool StudyRunner::activate(const StudyRow& study) {
  const auto results = store_.reader.find_results(study.sweep_id);
  if (!results) return false;
  ActiveStudy active{.sweep_id = study.sweep_id,
                     .common = ordered_json::parse(results->sweep.request),
                     .sampler = type_->make_sampler(study, *results)};
  active.common.erase("cases");
  for (const ResultRow& job : results->rows) active.change = std::max(active.change, job.change);
  active_.emplace(study.id, std::move(active));
  return true;
}

bool StudyRunner::tell_ended_jobs(ActiveStudy& study) {
  const auto ended = store_.reader.find_ended(study.sweep_id, study.change);
  for (const ResultRow& job : ended) study.sampler->tell(job);
  if (!ended.empty()) study.change = ended.back().change;
  return !ended.empty();
}

StudyChanges StudyRunner::add_next_cases(const StudyRow& study) {
  ActiveStudy& active = active_.at(study.id);
  const NextCases next = active.sampler->ask();
  set_progress(study.id, active.sampler->progress());
  if (next.end_state) {
    store_.studies.set_state(study.id, "running", *next.end_state, next.error);
    return {.any = true};
  }
  if (next.cases.empty()) return {.any = true};
  const bool added =
      store_.queue.add_cases(study.sweep_id, next.cases, plan_cases(active.common, next.cases));
  return {.any = true, .added = added};
}

void StudyRunner::set_progress(const std::string& id, double progress) {
  const std::lock_guard lock(progress_mutex_);
  progress_[id] = progress;
}

double StudyRunner::find_progress(const std::string& id) const {
  const std::lock_guard lock(progress_mutex_);
  const auto known = progress_.find(id);
  return known == progress_.end() ? 0.0 : known->second;
}

}  // namespace jobs
