// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/store_schema.h"

#include <algorithm>
#include <array>
#include <string>

#include <sqlite3.h>

#include "jobs/base/errors.h"
#include "jobs/store/store_connection.h"

namespace jobs {
namespace {

constexpr int kApplicationId = 0x52505355;  // "RPSU"

/// Step i brings a store from version i to i + 1. A released step is never changed; new ones follow. So some
/// names are older than what they hold: searches has the studies of all kinds, answers the responses that are
/// kept for idempotency keys, jobs.place the batch_index. A jobs.change below 0 is that of a former end.
constexpr std::array<const char*, 6> kMigrations{R"sql(
  CREATE TABLE sweeps (
    seq INTEGER PRIMARY KEY,
    id TEXT NOT NULL UNIQUE,
    name TEXT NOT NULL,
    request TEXT NOT NULL,
    swept TEXT NOT NULL,
    replicated INTEGER NOT NULL,
    created_ms INTEGER NOT NULL
  ) STRICT;

  CREATE TABLE contents (
    seq INTEGER PRIMARY KEY,
    content_id TEXT NOT NULL UNIQUE,
    engine_version TEXT NOT NULL,
    parameters TEXT NOT NULL
  ) STRICT;

  CREATE TABLE results (
    seq INTEGER PRIMARY KEY,
    content INTEGER NOT NULL REFERENCES contents,
    metrics TEXT,
    error_reason TEXT,
    error_detail TEXT,
    error_t_s REAL,
    wall_time_s REAL NOT NULL,
    cpu_time_s REAL NOT NULL,
    host TEXT NOT NULL,
    cpu TEXT NOT NULL,
    version TEXT NOT NULL,
    "commit" TEXT NOT NULL,
    compiler TEXT NOT NULL
  ) STRICT;
  CREATE INDEX results_by_content ON results (content);

  CREATE TABLE trajectories (
    result INTEGER PRIMARY KEY REFERENCES results ON DELETE CASCADE,
    data BLOB NOT NULL
  ) STRICT;

  CREATE TABLE jobs (
    seq INTEGER PRIMARY KEY,
    id TEXT NOT NULL UNIQUE,
    sweep INTEGER REFERENCES sweeps,
    replicate INTEGER,
    swept TEXT NOT NULL,
    state TEXT NOT NULL CHECK (state IN ('queued', 'running', 'succeeded', 'failed', 'cancelled')),
    content INTEGER NOT NULL REFERENCES contents,
    coupler TEXT NOT NULL,
    reuse INTEGER NOT NULL,
    reused INTEGER NOT NULL DEFAULT 0,
    attempt INTEGER NOT NULL DEFAULT 0,
    result INTEGER REFERENCES results,
    created_ms INTEGER NOT NULL,
    started_ms INTEGER,
    ended_ms INTEGER
  ) STRICT;
  CREATE INDEX jobs_by_sweep ON jobs (sweep, state, started_ms, ended_ms);
  CREATE INDEX jobs_by_content ON jobs (content);
  CREATE INDEX jobs_by_result ON jobs (result);
  CREATE INDEX queued_jobs ON jobs (sweep) WHERE state = 'queued';
  CREATE INDEX running_jobs ON jobs (content) WHERE state = 'running';
)sql",
                                                 R"sql(
  ALTER TABLE sweeps ADD COLUMN priority INTEGER NOT NULL DEFAULT 0;

  -- What its cost depends on most.
  ALTER TABLE jobs RENAME COLUMN coupler TO kind;

  -- The number of the change with which the job ended: they follow one another in the order of their commits.
  ALTER TABLE jobs ADD COLUMN change INTEGER;
  UPDATE jobs SET change = ended.number FROM
    (SELECT seq, row_number() OVER (ORDER BY ended_ms, seq) AS number FROM jobs WHERE state IN ('succeeded', 'failed', 'cancelled')) AS ended
    WHERE ended.seq = jobs.seq;
  CREATE INDEX ended_jobs ON jobs (sweep, change) WHERE change IS NOT NULL;

  CREATE TABLE answers (
    seq INTEGER PRIMARY KEY,
    key TEXT NOT NULL UNIQUE,
    request TEXT NOT NULL,
    answer TEXT NOT NULL,
    created_ms INTEGER NOT NULL
  ) STRICT;
  CREATE INDEX answers_by_age ON answers (created_ms);
)sql",
                                                 R"sql(
  -- What a sweep's cases are added for, one after the other.
  CREATE TABLE searches (
    sweep INTEGER PRIMARY KEY REFERENCES sweeps ON DELETE CASCADE,
    id TEXT NOT NULL UNIQUE,
    request TEXT NOT NULL,
    state TEXT NOT NULL DEFAULT 'running' CHECK (state IN ('running', 'succeeded', 'failed', 'cancelled')),
    error TEXT,
    ended_ms INTEGER
  ) STRICT;
  CREATE INDEX running_searches ON searches (sweep) WHERE state = 'running';
)sql",
                                                 R"sql(
  -- Which executor a sweep asks for; null: whichever the service computes with.
  ALTER TABLE sweeps ADD COLUMN executor TEXT;

  -- Tells this store's folder on a cluster from those of others.
  CREATE TABLE identity (id TEXT NOT NULL) STRICT;
  INSERT INTO identity VALUES (lower(hex(randomblob(8))));

  -- Jobs that were given to a cluster together; each has a place in its batch until it ends or is taken back.
  CREATE TABLE batches (
    seq INTEGER PRIMARY KEY,
    id TEXT NOT NULL UNIQUE,
    sweep_id TEXT,
    engine_version TEXT NOT NULL,
    created_ms INTEGER NOT NULL
  ) STRICT;
  ALTER TABLE jobs ADD COLUMN batch INTEGER REFERENCES batches;
  ALTER TABLE jobs ADD COLUMN place INTEGER;
  CREATE INDEX placed_jobs ON jobs (batch, place, state) WHERE batch IS NOT NULL;
  CREATE INDEX placed_contents ON jobs (content) WHERE batch IS NOT NULL;
  DROP INDEX queued_jobs;
  CREATE INDEX queued_jobs ON jobs (sweep, batch, state) WHERE state = 'queued' AND batch IS NULL;  -- all that is counted stands in it

  ALTER TABLE results ADD COLUMN libm TEXT NOT NULL DEFAULT '';
  ALTER TABLE results ADD COLUMN numerics TEXT NOT NULL DEFAULT '';
)sql",
                                                 R"sql(
  -- Signals that a lab has measured. The samples stand last: rows are read without them.
  CREATE TABLE measurements (
    seq INTEGER PRIMARY KEY,
    id TEXT NOT NULL UNIQUE,
    name TEXT NOT NULL,
    description TEXT NOT NULL,
    created_ms INTEGER NOT NULL,
    bytes INTEGER NOT NULL,
    data BLOB NOT NULL
  ) STRICT;
)sql",
                                                 R"sql(
  -- Of people, for people: a text, and a JSON list of words.
  ALTER TABLE sweeps ADD COLUMN notes TEXT NOT NULL DEFAULT '';
  ALTER TABLE sweeps ADD COLUMN tags TEXT NOT NULL DEFAULT '[]';
)sql"};
constexpr int kNewestVersion = static_cast<int>(kMigrations.size());

int pragma(SQLite::Database& database, const std::string& name) {
  return database.execAndGet("PRAGMA " + name).getInt();
}

bool is_empty(SQLite::Database& database) {
  return database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() == 0;
}

/// The beginning, on one line: SQLite names up to a hundred damaged pages.
std::string shortened(std::string text) {
  constexpr std::size_t kLongest = 200;
  std::ranges::replace(text, '\n', ' ');
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + " ...";
}

/// Looks at all but trajectories and measurements: they are nearly all of a large store, and each carries its
/// own checksum.
void check_health(SQLite::Database& database, const std::string& name) {
  SQLite::Statement tables(database,
                           "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT IN "
                           "('trajectories', 'measurements') AND name NOT LIKE 'sqlite_%'");
  while (tables.executeStep()) {
    const std::string table = tables.getColumn(0).getString();
    const std::string verdict = database.execAndGet("PRAGMA quick_check(" + table + ")").getString();
    if (verdict != "ok")
      throw StorageError(
          "the store " + name + " is damaged (" + shortened(verdict) + "); it has been left as it is",
          SQLITE_CORRUPT);
  }
}

void check_identity(SQLite::Database& database, const std::string& name) {
  const int version = pragma(database, "user_version");
  if (!is_store(database) && !(version == 0 && is_empty(database))) {
    throw StorageError(name + " is a database, but not a store of this program; it has been left as it is",
                       SQLITE_NOTADB);
  }
  if (version < 0 || (version == 0 && !is_empty(database))) {
    throw StorageError("the store " + name + " says that it is of form " + std::to_string(version) +
                           ", which no program has written: it is damaged; it has been left as it is",
                       SQLITE_CORRUPT);
  }
  if (version > kNewestVersion) {
    throw StorageError("the store " + name + " is of a newer program (form " + std::to_string(version) +
                           ", this one knows " + std::to_string(kNewestVersion) +
                           "); it has been left as it is",
                       SQLITE_MISMATCH);
  }
}

/// @throws StorageError if the file system cannot hold a log
void prepare_file(SQLite::Database& database, const std::string& name) {
  // Large pages suit large trajectories. Neither takes effect in a file that has tables, but the second is
  // written all the same.
  if (is_empty(database)) database.exec("PRAGMA page_size = 8192; PRAGMA auto_vacuum = INCREMENTAL");
  if (database.execAndGet("PRAGMA journal_mode = WAL").getString() != "wal") {
    throw StorageError(
        "the store " + name + " lies on a file system that does not share memory, as a network's",
        SQLITE_CANTOPEN);
  }
}

void migrate(SQLite::Database& database) {
  for (int version = pragma(database, "user_version"); version < kNewestVersion; ++version) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    database.exec(kMigrations.at(static_cast<std::size_t>(version)));
    database.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
    database.exec("PRAGMA user_version = " + std::to_string(version + 1));
    transaction.commit();
  }
}

}  // namespace

bool is_store(SQLite::Database& database) { return pragma(database, "application_id") == kApplicationId; }

void prepare_schema(SQLite::Database& database, const std::filesystem::path& store) {
  const std::string name = store.string();
  try {
    check_identity(database, name);
    if (pragma(database, "user_version") > 0) check_health(database, name);
    prepare_file(database, name);
    migrate(database);
  } catch (const SQLite::Exception& error) {
    const int code = error.getErrorCode();
    if (!is_damage(code)) throw;
    throw StorageError(
        "the store " + name + " is damaged or no database (" + error.what() + "); it has been left as it is",
        code);
  }
}

}  // namespace jobs
