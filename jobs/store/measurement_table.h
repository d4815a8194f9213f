// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "jobs/measurements/measurement_codec.h"
#include "jobs/store/idempotency_record.h"
#include "jobs/store/rows.h"
#include "jobs/store/store_core.h"

namespace jobs {

/// Measurements with their samples. May be called from any thread. Throws StorageError.
class MeasurementTable {
 public:
  explicit MeasurementTable(StoreCore& core) : core_(core) {}

  /// Stores a measurement. Returns its id. @throws StoreLimitReached if there is no room
  std::string add(const PackedMeasurement& measurement,
                  const IdempotencyRecord<MeasurementRow>& idempotency = {});
  /// Measurement with its samples.
  [[nodiscard]] std::optional<Measurement> find(const std::string& id) const;
  [[nodiscard]] std::optional<MeasurementRow> find_row(const std::string& id) const;
  /// Packed samples, as encode_samples() makes them.
  [[nodiscard]] std::optional<std::string> find_samples(const std::string& id) const;
  /// Newest first. @param before  an id; empty: the newest
  [[nodiscard]] std::vector<MeasurementRow> list(const std::string& before, std::size_t limit) const;
  /// Deletes a measurement, also on a full disk. False if there is none.
  /// @throws WrongState if a study has it in its request
  bool erase(const std::string& id);

 private:
  StoreCore& core_;
};

}  // namespace jobs
