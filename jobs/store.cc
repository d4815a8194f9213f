#include "jobs/store.h"

#include "jobs/content_id.h"
#include "jobs/program_info.h"
#include "jobs/time_text.h"

namespace jobs {
namespace {

/// Stores jobs inside one transaction; its statements are prepared once.
class JobInserter {
 public:
  JobInserter(SQLite::Database& database, IdMaker& ids, std::int64_t now_ms)
      : ids_(ids),
        now_ms_(now_ms),
        add_content_(database, "INSERT INTO contents (content_id, engine_version, parameters) VALUES (?, ?, ?) ON CONFLICT DO NOTHING"),
        find_content_(database, "SELECT seq FROM contents WHERE content_id = ?"),
        find_result_(database, "SELECT max(seq) FROM results WHERE content = ? AND error_reason IS NULL"),
        add_job_(database,
                 "INSERT INTO jobs (id, sweep, replicate, swept, content, coupler, reuse, created_ms, state, result, reused, started_ms, ended_ms) "
                 "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)") {}

  std::string insert(const PlannedJob& job, std::optional<std::int64_t> sweep, bool reuse) {
    const std::int64_t content = content_of(job);
    const auto result = reuse ? known_result(content) : std::nullopt;
    std::string id = ids_.make(kJobPrefix, now_ms_);
    add_job_.reset();
    add_job_.clearBindings();  // what is not bound below is null
    add_job_.bind(1, id);
    if (sweep) add_job_.bind(2, *sweep);
    if (job.replicate) add_job_.bind(3, static_cast<std::int64_t>(*job.replicate));
    add_job_.bind(4, job.swept);
    add_job_.bind(5, content);
    add_job_.bind(6, job.coupler);
    add_job_.bind(7, reuse ? 1 : 0);
    add_job_.bind(8, now_ms_);
    add_job_.bind(9, std::string(state_name(result ? JobState::kSucceeded : JobState::kQueued)));
    add_job_.bind(11, result ? 1 : 0);
    if (result) {
      add_job_.bind(10, *result);
      add_job_.bind(12, now_ms_);
      add_job_.bind(13, now_ms_);
    }
    add_job_.exec();
    return id;
  }

 private:
  std::int64_t content_of(const PlannedJob& job) {
    add_content_.reset();
    add_content_.bind(1, job.content_id);
    add_content_.bind(2, std::string(kEngineVersion));
    add_content_.bind(3, job.parameters);
    add_content_.exec();
    find_content_.reset();
    find_content_.bind(1, job.content_id);
    find_content_.executeStep();
    return find_content_.getColumn(0).getInt64();
  }

  std::optional<std::int64_t> known_result(std::int64_t content) {
    find_result_.reset();
    find_result_.bind(1, content);
    find_result_.executeStep();
    const SQLite::Column result = find_result_.getColumn(0);
    return result.isNull() ? std::nullopt : std::optional(result.getInt64());
  }

  IdMaker& ids_;
  std::int64_t now_ms_;
  SQLite::Statement add_content_, find_content_, find_result_, add_job_;
};

/// Throws, and so undoes the transaction, if there is no room for what has just been added.
void check_room(SQLite::Database& database, std::size_t max_queued) {
  const auto queued = database.execAndGet("SELECT count(*) FROM jobs WHERE state = 'queued'").getInt64();
  if (static_cast<std::size_t>(queued) > max_queued) {
    throw QueueFull("with these, " + std::to_string(queued) + " jobs would be waiting; at most " + std::to_string(max_queued) + " may");
  }
}

/// Jobs that a former version of the engine was to compute have results of that version as theirs; give them new names.
void rename_queued_contents(SQLite::Database& database) {
  SQLite::Statement old(database,
                        "SELECT DISTINCT c.seq, c.parameters FROM jobs j JOIN contents c ON c.seq = j.content "
                        "WHERE j.state = 'queued' AND c.engine_version <> ?");
  old.bind(1, std::string(kEngineVersion));
  std::vector<std::pair<std::int64_t, std::string>> contents;
  while (old.executeStep()) contents.emplace_back(old.getColumn(0).getInt64(), old.getColumn(1).getString());
  for (const auto& [seq, parameters] : contents) {
    const std::string name = content_id(parameters, kEngineVersion);
    SQLite::Statement add(database, "INSERT INTO contents (content_id, engine_version, parameters) VALUES (?, ?, ?) ON CONFLICT DO NOTHING");
    add.bind(1, name);
    add.bind(2, std::string(kEngineVersion));
    add.bind(3, parameters);
    add.exec();
    SQLite::Statement move(database, "UPDATE jobs SET content = (SELECT seq FROM contents WHERE content_id = ?) WHERE content = ? AND state = 'queued'");
    move.bind(1, name);
    move.bind(2, seq);
    move.exec();
  }
}

std::int64_t insert_sweep(SQLite::Database& database, const std::string& id, const SweepPlan& plan, const std::string& request, std::int64_t now_ms) {
  SQLite::Statement add(database, "INSERT INTO sweeps (id, name, request, swept, replicated, created_ms) VALUES (?, ?, ?, ?, ?, ?)");
  add.bind(1, id);
  add.bind(2, plan.name);
  add.bind(3, request);
  add.bind(4, nlohmann::json(plan.swept).dump());
  add.bind(5, plan.replicated ? 1 : 0);
  add.bind(6, now_ms);
  add.exec();
  return database.getLastInsertRowid();
}

}  // namespace

Store::Store(const std::filesystem::path& file) : lock_(file), writer_(file), readers_(file) {
  writer_.write(Durability::kSurvivesPowerLoss, [](SQLite::Database& database) {
    database.exec("UPDATE jobs SET state = 'queued', started_ms = NULL WHERE state = 'running'");
    rename_queued_contents(database);
  });
}

std::string Store::add_sweep(const SweepPlan& plan, const std::string& request, std::size_t max_queued) {
  return writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    const std::int64_t now_ms = now_unix_ms();
    std::string id = ids_.make(kSweepPrefix, now_ms);
    const std::int64_t sweep = insert_sweep(database, id, plan, request, now_ms);
    JobInserter inserter(database, ids_, now_ms);
    for (const PlannedJob& job : plan.jobs) inserter.insert(job, sweep, plan.reuse);
    check_room(database, max_queued);
    return id;
  });
}

std::string Store::add_job(const PlannedJob& job, std::size_t max_queued) {
  return writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    std::string id = JobInserter(database, ids_, now_unix_ms()).insert(job, std::nullopt, true);
    check_room(database, max_queued);
    return id;
  });
}

std::string_view sweep_state(const StateCounts& counts) {
  const auto count = [&](JobState state) { return counts[static_cast<std::size_t>(state)]; };
  if (!has_ended(counts)) {
    const bool untouched = count(JobState::kRunning) + count(JobState::kSucceeded) + count(JobState::kFailed) + count(JobState::kCancelled) == 0;
    return state_name(untouched ? JobState::kQueued : JobState::kRunning);
  }
  if (count(JobState::kCancelled) > 0) return state_name(JobState::kCancelled);
  return state_name(count(JobState::kFailed) > 0 ? JobState::kFailed : JobState::kSucceeded);
}

bool has_ended(const StateCounts& counts) {
  return counts[static_cast<std::size_t>(JobState::kQueued)] + counts[static_cast<std::size_t>(JobState::kRunning)] == 0;
}

}  // namespace jobs
