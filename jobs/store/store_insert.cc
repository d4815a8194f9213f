// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/store_insert.h"

#include <vector>

#include "jobs/base/content_id.h"
#include "jobs/base/provenance.h"
#include "jobs/base/states.h"
#include "jobs/base/errors.h"

namespace jobs {

namespace {

constexpr const char* kAddContent =
    "INSERT INTO contents (content_id, engine_version, parameters) VALUES (?, ?, ?) ON CONFLICT DO NOTHING";

}  // namespace

JobInserter::JobInserter(SQLite::Database& database, IdMaker& ids, std::int64_t now_ms, std::int64_t change)
    : ids_(ids),
      now_ms_(now_ms),
      change_(change),
      add_content_(database, kAddContent),
      find_content_(database, "SELECT seq FROM contents WHERE content_id = ?"),
      find_result_(database, "SELECT max(seq) FROM results WHERE content = ? AND error_reason IS NULL"),
      add_job_(
          database,
          "INSERT INTO jobs (id, sweep, replicate, swept, content, kind, reuse, created_ms, state, result, "
          "reused, started_ms, ended_ms, change) "
          "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)") {}

std::string JobInserter::insert(const PlannedJob& job, const JobOwner& owner) {
  const std::int64_t content = content_of(job);
  const auto result = owner.reuse ? known_result(content) : std::nullopt;
  std::string id = ids_.make(kJobPrefix, now_ms_);
  add_job_.reset();
  add_job_.clearBindings();  // parameters that are not bound below are null
  add_job_.bind(1, id);
  if (owner.sweep) add_job_.bind(2, *owner.sweep);
  if (job.replicate) add_job_.bind(3, static_cast<std::int64_t>(*job.replicate));
  add_job_.bind(4, job.swept);
  add_job_.bind(5, content);
  add_job_.bind(6, job.kind);
  add_job_.bind(7, owner.reuse ? 1 : 0);
  add_job_.bind(8, now_ms_);
  add_job_.bind(9, std::string(state_name(result ? JobState::kSucceeded : JobState::kQueued)));
  add_job_.bind(11, result ? 1 : 0);
  if (result) {
    add_job_.bind(10, *result);
    add_job_.bind(12, now_ms_);
    add_job_.bind(13, now_ms_);
    add_job_.bind(14, change_);
  }
  add_job_.exec();
  return id;
}

std::int64_t JobInserter::content_of(const PlannedJob& job) {
  add_content_.reset();
  add_content_.bind(1, job.content_id);
  add_content_.bind(2, engine_version());
  add_content_.bind(3, job.parameters);
  add_content_.exec();
  find_content_.reset();
  find_content_.bind(1, job.content_id);
  find_content_.executeStep();
  return find_content_.getColumn(0).getInt64();
}

std::optional<std::int64_t> JobInserter::known_result(std::int64_t content) {
  find_result_.reset();
  find_result_.bind(1, content);
  find_result_.executeStep();
  const SQLite::Column result = find_result_.getColumn(0);
  return result.isNull() ? std::nullopt : std::optional(result.getInt64());
}

std::int64_t insert_sweep(SQLite::Database& database, IdMaker& ids, const std::string& id,
                          const SweepPlan& plan, const std::string& request, const Submission& submission) {
  SQLite::Statement add(
      database,
      "INSERT INTO sweeps (id, name, request, swept, replicated, priority, created_ms, executor) VALUES (?, "
      "?, ?, ?, ?, ?, ?, ?)");
  add.bind(1, id);
  add.bind(2, plan.name);
  add.bind(3, request);
  add.bind(4, nlohmann::json(plan.swept).dump());
  add.bind(5, plan.replicated ? 1 : 0);
  add.bind(6, plan.priority);
  add.bind(7, submission.now_ms);
  if (!plan.executor.empty()) add.bind(8, plan.executor);
  add.exec();
  const std::int64_t sweep = database.getLastInsertRowid();
  JobInserter inserter(database, ids, submission.now_ms, submission.change);
  for (const PlannedJob& job : plan.jobs) inserter.insert(job, {sweep, plan.reuse});
  check_queue_limit(database, submission.max_queued);
  return sweep;
}

void check_queue_limit(SQLite::Database& database, std::size_t max_queued) {
  const auto queued = database.execAndGet(kQueuedCount).getInt64();
  if (static_cast<std::size_t>(queued) > max_queued) {
    throw QueueFull("with these, " + std::to_string(queued) + " jobs would be waiting; at most " +
                    std::to_string(max_queued) + " may");
  }
}

namespace {

/// Content of queued jobs.
struct QueuedContent {
  std::int64_t seq = 0;
  std::string parameters;
};

std::vector<QueuedContent> find_contents_of_other_engines(SQLite::Database& database) {
  SQLite::Statement old(database,
                        "SELECT DISTINCT c.seq, c.parameters FROM jobs j JOIN contents c ON c.seq = "
                        "j.content "
                        "WHERE j.state = 'queued' AND c.engine_version <> ?");
  old.bind(1, engine_version());
  std::vector<QueuedContent> contents;
  while (old.executeStep())
    contents.push_back({.seq = old.getColumn(0).getInt64(), .parameters = old.getColumn(1).getString()});
  return contents;
}

/// Adds the content of this engine, unless there is one.
void insert_content(SQLite::Database& database, const std::string& id, const std::string& parameters) {
  SQLite::Statement add(database, kAddContent);
  add.bind(1, id);
  add.bind(2, engine_version());
  add.bind(3, parameters);
  add.exec();
}

/// @param id  content_id of the new content
void move_queued_jobs(SQLite::Database& database, std::int64_t former, const std::string& id) {
  SQLite::Statement move(
      database,
      "UPDATE jobs SET content = (SELECT seq FROM contents WHERE content_id = ?) WHERE content = ? AND "
      "state = 'queued'");
  move.bind(1, id);
  move.bind(2, former);
  move.exec();
}

}  // namespace

void rekey_queued_jobs(SQLite::Database& database) {
  for (const auto& [seq, parameters] : find_contents_of_other_engines(database)) {
    const std::string id = content_id(parameters, engine_version());
    insert_content(database, id, parameters);
    move_queued_jobs(database, seq, id);
  }
}

std::optional<std::int64_t> find_sweep_seq(const SQLite::Database& database, const std::string& id) {
  SQLite::Statement find(database, "SELECT seq FROM sweeps WHERE id = ?");
  find.bind(1, id);
  return find.executeStep() ? std::optional(find.getColumn(0).getInt64()) : std::nullopt;
}

}  // namespace jobs
