// SPDX-License-Identifier: Apache-2.0
// SQL: the column place of jobs is their batch_index.
#include "jobs/store/store_results.h"

namespace jobs {
namespace {

/// @param metrics  outlives the statement
void bind_record(const Statements::Use& add, const RunRecord& record, const std::string& metrics) {
  if (record.end == RunRecord::End::kSucceeded) {
    add->bindNoCopy(2, metrics);
  } else {
    add->bind(3, record.error_reason);
    add->bind(4, record.error_detail);
    if (record.error_t_s) add->bind(5, *record.error_t_s);
  }
  add->bind(6, record.wall_time_s);
  add->bind(7, record.cpu_time_s);
}

/// @param provenance  outlives the statement
void bind_provenance(const Statements::Use& add, const Provenance& provenance) {
  int column = 8;
  for (const std::string* text : {&provenance.host, &provenance.cpu, &provenance.version, &provenance.commit,
                                  &provenance.compiler, &provenance.libm, &provenance.numerics}) {
    add->bindNoCopy(column++, *text);
  }
}

}  // namespace

std::int64_t insert_result(Statements& statements, std::int64_t content, const RunRecord& record,
                           const std::string& metrics, const Provenance& provenance) {
  const auto add = statements.use(
      "INSERT INTO results (content, metrics, error_reason, error_detail, error_t_s, wall_time_s, "
      "cpu_time_s, host, cpu, version, "
      "\"commit\", compiler, libm, numerics) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) RETURNING "
      "seq");
  add->bind(1, content);
  bind_record(add, record, metrics);
  bind_provenance(add, provenance);
  add->executeStep();
  const std::int64_t result = add->getColumn(0).getInt64();
  add->executeStep();
  return result;
}

void insert_trajectory(Statements& statements, std::int64_t result, const std::string& blob) {
  const auto add = statements.use("INSERT INTO trajectories (result, data) VALUES (?, ?)");
  add->bind(1, result);
  add->bindNoCopy(2, blob.data(), static_cast<int>(blob.size()));
  add->exec();
}

void complete_duplicates(Statements& statements, std::int64_t content, std::int64_t result,
                         std::int64_t now_ms, std::int64_t change) {
  const auto settle = statements.use(
      "UPDATE jobs SET state = 'succeeded', result = ?, reused = 1, started_ms = max(?, created_ms), "
      "ended_ms = max(?, created_ms), change = ?, "
      "batch = NULL, place = NULL "
      "WHERE content = ? AND state = 'queued' AND reuse = 1");
  settle->bind(1, result);
  settle->bind(2, now_ms);
  settle->bind(3, now_ms);
  settle->bind(4, change);
  settle->bind(5, content);
  settle->exec();
}

}  // namespace jobs
