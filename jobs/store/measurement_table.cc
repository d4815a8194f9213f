// SPDX-License-Identifier: Apache-2.0
// SQL: the table searches holds the studies of all kinds.
#include "jobs/store/measurement_table.h"

#include <cstdint>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/base/errors.h"
#include "jobs/base/ids.h"
#include "jobs/base/study_kind.h"
#include "jobs/base/time_text.h"
#include "jobs/store/store_insert.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {
namespace {

constexpr const char* kMeasurementQuery = "SELECT id, name, description, created_ms, bytes FROM measurements";

MeasurementRow measurement_row(SQLite::Statement& found) {
  MeasurementRow row;
  row.id = found.getColumn(0).getString();
  row.name = found.getColumn(1).getString();
  row.description = found.getColumn(2).getString();
  row.created_ms = found.getColumn(3).getInt64();
  row.bytes = found.getColumn(4).getInt64();
  return row;
}

void insert_measurement(SQLite::Database& database, const MeasurementRow& row, const std::string& data) {
  SQLite::Statement add(
      database,
      "INSERT INTO measurements (id, name, description, data, created_ms, bytes) VALUES (?, ?, ?, ?, ?, ?)");
  add.bind(1, row.id);
  add.bind(2, row.name);
  add.bind(3, row.description);
  add.bindNoCopy(4, data.data(), static_cast<int>(data.size()));
  add.bind(5, row.created_ms);
  add.bind(6, row.bytes);
  add.exec();
}

/// Id of a study that has the measurement in its request.
std::optional<std::string> find_use(const SQLite::Database& database, const std::string& id) {
  SQLite::Statement find(database, "SELECT id FROM searches WHERE instr(request, ?) > 0 LIMIT 1");
  find.bind(1, "\"" + id + "\"");
  return find.executeStep() ? std::optional(find.getColumn(0).getString()) : std::nullopt;
}

}  // namespace

std::string MeasurementTable::add(const PackedMeasurement& measurement,
                                  const IdempotencyRecord<MeasurementRow>& idempotency) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    const std::int64_t now_ms = now_unix_ms();
    const MeasurementRow row{.id = core_.ids.make(kMeasurementPrefix, now_ms),
                             .name = measurement.name,
                             .description = measurement.description,
                             .created_ms = now_ms,
                             .bytes = static_cast<std::int64_t>(measurement.samples.size())};
    insert_measurement(database, row, measurement.samples);
    respond(database, idempotency, [&] { return row; });
    core_.check_quota(database);
    return row.id;
  });
}

std::optional<MeasurementRow> MeasurementTable::find_row(const std::string& id) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement find(database, std::string(kMeasurementQuery) + " WHERE id = ?");
    find.bind(1, id);
    return find.executeStep() ? std::optional(measurement_row(find)) : std::nullopt;
  });
}

std::optional<std::string> MeasurementTable::find_samples(const std::string& id) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement find(database, "SELECT data FROM measurements WHERE id = ?");
    find.bind(1, id);
    return find.executeStep() ? std::optional(find.getColumn(0).getString()) : std::nullopt;
  });
}

std::optional<Measurement> MeasurementTable::find(const std::string& id) const {
  const auto row = find_row(id);
  const auto samples = row ? find_samples(id) : std::nullopt;
  if (!samples) return std::nullopt;
  try {
    return unpack({.name = row->name, .description = row->description, .samples = *samples});
  } catch (const DamagedTrajectory& damage) {
    throw StorageError("the samples of " + id + " cannot be read: " + damage.what());
  }
}

std::vector<MeasurementRow> MeasurementTable::list(const std::string& before, std::size_t limit) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement list(
        database, std::string(kMeasurementQuery) + " WHERE (?1 = '' OR id < ?1) ORDER BY id DESC LIMIT ?2");
    list.bind(1, before);
    list.bind(2, static_cast<std::int64_t>(limit));
    std::vector<MeasurementRow> rows;
    while (list.executeStep()) rows.push_back(measurement_row(list));
    return rows;
  });
}

bool MeasurementTable::erase(const std::string& id) {
  return core_.write_in_held_room([&](SQLite::Database& database) {
    if (const auto study = find_use(database, id))
      throw WrongState("the measurement is used by " + name_of_study(*study) + "; delete that first");
    SQLite::Statement erase(database, "DELETE FROM measurements WHERE id = ?");
    erase.bind(1, id);
    return erase.exec() > 0;
  });
}

}  // namespace jobs
