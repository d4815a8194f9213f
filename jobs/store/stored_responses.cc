// SPDX-License-Identifier: Apache-2.0
// SQL: the table answers holds the responses that are kept for idempotency keys.
#include "jobs/base/time_text.h"
#include "jobs/store/store_insert.h"
#include "jobs/store/sweep_reader.h"

namespace jobs {
namespace {

constexpr std::int64_t kResponsesAreKept_ms = 7LL * 24 * 3600 * 1000;

}  // namespace

void store_response(SQLite::Database& database, const std::string& key, const std::string& fingerprint,
                    const std::string& response) {
  const std::int64_t now_ms = now_unix_ms();
  // A week before the newest one, too: a clock that is ahead once must not empty the table.
  SQLite::Statement forget(
      database, "DELETE FROM answers WHERE created_ms < min(?1, (SELECT max(created_ms) FROM answers)) - ?2");
  forget.bind(1, now_ms);
  forget.bind(2, kResponsesAreKept_ms);
  forget.exec();
  // A response of the same key may be too old to be found, and not deleted yet.
  SQLite::Statement add(
      database, "INSERT OR REPLACE INTO answers (key, request, answer, created_ms) VALUES (?, ?, ?, ?)");
  add.bind(1, key);
  add.bind(2, fingerprint);
  add.bind(3, response);
  add.bind(4, now_ms);
  add.exec();
}

std::optional<StoredResponse> SweepReader::find_response(const std::string& key) const {
  return core_.readers.read([&](const SQLite::Database& database) -> std::optional<StoredResponse> {
    SQLite::Statement find(database, "SELECT request, answer FROM answers WHERE key = ? AND created_ms >= ?");
    find.bind(1, key);
    find.bind(2, now_unix_ms() - kResponsesAreKept_ms);
    if (!find.executeStep()) return std::nullopt;
    return StoredResponse{.fingerprint = find.getColumn(0).getString(),
                          .text = find.getColumn(1).getString()};
  });
}

}  // namespace jobs
