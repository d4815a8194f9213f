// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/base/ids.h"
#include "jobs/requests/expand.h"
#include "jobs/store/idempotency_record.h"

namespace jobs {

/// Sweep of a job, and whether a known result may be reused.
struct JobOwner {
  std::optional<std::int64_t> sweep;
  bool reuse = true;
};

/// Stores jobs inside one transaction; its statements are prepared once.
class JobInserter {
 public:
  /// @param change  of the jobs that succeed at once
  JobInserter(SQLite::Database& database, IdMaker& ids, std::int64_t now_ms, std::int64_t change);

  /// Stores a job, as succeeded if its result is known and may be reused. Returns its id.
  std::string insert(const PlannedJob& job, const JobOwner& owner);

 private:
  std::int64_t content_of(const PlannedJob& job);
  std::optional<std::int64_t> known_result(std::int64_t content);

  IdMaker& ids_;
  std::int64_t now_ms_;
  std::int64_t change_;
  SQLite::Statement add_content_, find_content_, find_result_, add_job_;
};

/// Numbers of a submission.
struct Submission {
  std::int64_t now_ms = 0;
  std::int64_t change = 0;  ///< of the jobs that succeed at once
  std::size_t max_queued = 0;
};

/// Stores a sweep with its jobs. Returns its number. Throws QueueFull if there is no room for them.
std::int64_t insert_sweep(SQLite::Database& database, IdMaker& ids, const std::string& id,
                          const SweepPlan& plan, const std::string& request, const Submission& submission);
/// Number of jobs that wait, here or in the queue of a cluster: both counts walk an index that holds little
/// else.
inline constexpr const char* kQueuedCount =
    "SELECT (SELECT count(*) FROM jobs WHERE state = 'queued' AND batch IS NULL) + "
    "(SELECT count(*) FROM jobs WHERE state = 'queued' AND batch IS NOT NULL)";

/// Throws QueueFull, and so undoes the transaction, if there is no room for what has just been added.
void check_queue_limit(SQLite::Database& database, std::size_t max_queued);

/// Gives queued jobs the content of this engine: results of a former one are not theirs.
void rekey_queued_jobs(SQLite::Database& database);

/// Gives a study another state. False, and nothing is stored, if it is not in the former one.
bool set_study_state(SQLite::Database& database, const std::string& id, const std::string& former,
                     const std::string& state, const std::optional<std::string>& error = {});

/// Lets the study of a sweep go on, if there is one.
void restart_study(SQLite::Database& database, std::int64_t sweep);

/// Stores the response to a request under its key, and deletes those that are too old.
void store_response(SQLite::Database& database, const std::string& key, const std::string& fingerprint,
                    const std::string& response);

/// Makes the response to the request that has made a row, and stores it if the request has a key.
/// @param read_row  is asked for the row if anybody wants a response
template <typename Row, typename ReadRow>
void respond(SQLite::Database& database, const IdempotencyRecord<Row>& idempotency, const ReadRow& read_row) {
  if (!idempotency.make_response) return;
  const std::string response = idempotency.make_response(read_row());
  if (!idempotency.key.empty()) store_response(database, idempotency.key, idempotency.fingerprint, response);
}

[[nodiscard]] std::optional<std::int64_t> find_sweep_seq(const SQLite::Database& database,
                                                         const std::string& id);

}  // namespace jobs
