// SPDX-License-Identifier: Apache-2.0
// Studies of the service, and the thread that lets them go on.

#include <exception>
#include <memory>
#include <span>

#include "jobs/base/content_id.h"
#include "jobs/service.h"
#include "jobs/store/store.h"
#include "jobs/studies/study_runner.h"

namespace jobs {
namespace {

using nlohmann::json;

StudyChanges advance_all(std::span<const std::unique_ptr<StudyRunner>> runners) {
  StudyChanges changes;
  for (const auto& runner : runners) changes.add(runner->advance());
  return changes;
}

}  // namespace

json Service::submit_study(StudyKind kind, const nlohmann::ordered_json& request, const std::string& key) {
  const std::string route = "POST " + std::string(kind_info(kind).path) + " ";
  return answer_once(key, route + sha256_hex(request.dump()), [&](const IdempotentRequest& idempotency) {
    json begun = runner(kind).submit(request, idempotency);
    wake();
    tell_change();  // its first results may be known already
    return begun;
  });
}

std::optional<json> Service::find_study(StudyKind kind, const std::string& id) const {
  return runner(kind).find(id);
}

json Service::list_studies(StudyKind kind, const PageQuery& query) const { return runner(kind).list(query); }

std::optional<ResultTable> Service::find_study_table(StudyKind kind, const std::string& id,
                                                     const ResultQuery& query) const {
  auto table = runner(kind).find_table(id);
  if (table) jobs::apply(query, *table, kStudyColumns);
  return table;
}

std::optional<ResultTable> Service::find_study_signals(StudyKind kind, const std::string& id,
                                                       const ResultQuery& query) const {
  auto table = runner(kind).find_signal_table(id);
  if (table) jobs::apply(query, *table, kStudyColumns);
  return table;
}

std::optional<SweepNews> Service::find_study_news(StudyKind kind, const std::string& id,
                                                  std::int64_t after) const {
  const auto row = runner(kind).find_row(id);
  if (!row) return std::nullopt;
  auto news = find_news(row->sweep_id, after);
  if (!news) return std::nullopt;
  const bool runs = row->state == "running";
  news->progress = {{"id", id},
                    {"sweep_id", row->sweep_id},
                    {"state", row->state},
                    {"counts", news->progress.at("counts")},
                    {"progress", runs ? runner(kind).find_progress(id) : 1.0}};
  news->ended = news->ended && !runs;
  return news;
}

bool Service::wait_for_study(StudyKind kind, const std::string& id, std::chrono::milliseconds at_most) const {
  return changes_.wait_for(at_most, [&]() -> std::optional<bool> {
    const auto row = runner(kind).find_row(id);
    return row ? std::optional(row->state != "running") : std::nullopt;
  });
}

std::optional<json> Service::cancel_study(StudyKind kind, const std::string& id) {
  const auto cancel = [&] { finish_cancelling(store_->queue.cancel_study(id), nullptr); };
  return runner(kind).cancel(id, cancel) ? runner(kind).find(id) : std::nullopt;
}

std::optional<json> Service::retry_study(StudyKind kind, const std::string& id) {
  check_open();
  const auto retry_sweep = [this](const std::string& sweep) {
    store_->queue.retry_sweep(sweep, options_.max_queued_jobs);
  };
  if (!runner(kind).retry(id, retry_sweep)) return std::nullopt;
  wake();
  tell_change();
  return runner(kind).find(id);
}

bool Service::delete_study(StudyKind kind, const std::string& id) {
  const auto sweep = runner(kind).find_ended_sweep(id);
  return sweep && delete_sweep(*sweep, id);
}

void Service::change_sweep(const std::string& id, const std::function<void()>& change,
                           std::size_t first_kind) {
  if (first_kind == runners_.size()) return change();
  runners_[first_kind]->change_sweep(id, [&] { change_sweep(id, change, first_kind + 1); });
}

void Service::run_studies() {
  constexpr std::chrono::seconds kPause{5};  // after a failure of the store
  while (!changes_.is_closed()) {
    const std::uint64_t seen = changes_.count();
    try {
      const StudyChanges changes = advance_all(runners_);
      if (changes.added) wake();
      if (changes.any) tell_change();
      if (changes.failure) std::rethrow_exception(changes.failure);
      changes_.wait(seen);
    } catch (const std::exception& error) {  // the store's errors, or no memory
      options_.log(std::string("the studies could not go on yet: ") + error.what());
      changes_.wait_until_closed(kPause);
    }
  }
}

}  // namespace jobs
