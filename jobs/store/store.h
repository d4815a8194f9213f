// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "jobs/base/provenance.h"
#include "jobs/store/cluster_batches.h"
#include "jobs/store/job_queue.h"
#include "jobs/store/measurement_table.h"
#include "jobs/store/study_table.h"
#include "jobs/store/sweep_reader.h"

namespace jobs {

/// Store of everything that is kept on disk, and all the SQL, in five interfaces. May be called from any
/// thread. Throws StorageError. No time that is stored is before one that it follows, even if the clock is
/// set back in between.
class Store {
 public:
  /// Opens or makes the file, and queues again what a former process left running.
  /// @param quota  what would add to more is a StoreLimitReached, while reading, cancelling and deleting go
  ///     on
  explicit Store(const std::filesystem::path& file, const StoreQuota& quota = {});

  /// Engine for which the newest job was planned when the store was opened; this program's own in a new
  /// store.
  [[nodiscard]] const std::string& engine_before() const { return engine_before_; }
  /// Keeps or gives up a store that was made here: a refused start gives it up.
  void keep(bool kept) {
    core_.writer.keep(kept);
    core_.lock.keep(kept);
  }
  /// Makes the file smaller by what deleting has freed, which needs room on the disk for a while. Room that
  /// is not released is used again.
  void release_free_pages();

  /// Checks that the disk is not full, and that results are stored. A store on a full disk is opened for
  /// reading, cancelling and deleting, and can be added to as soon as there is room.
  /// @throws StorageError, full
  void check_room();
  /// Reason for not storing results, as long as none is stored; empty: they are stored.
  [[nodiscard]] std::string refusal() const { return core_.refusal.reason(); }
  /// Bytes that may still be added, by the limits and by what the disk has left.
  [[nodiscard]] std::int64_t find_bytes_left();
  /// Place of the log's index: in memory if the disk was full, and no room was held for opening the store.
  [[nodiscard]] LogIndex log_index() const { return core_.writer.log_index(); }

 private:
  /// Reads what is kept in memory, and begins unless the disk is full.
  void open();

  StoreCore core_;
  std::string engine_before_ = engine_version();

 public:
  JobQueue queue{core_};
  ClusterBatches batches{core_};
  StudyTable studies{core_};
  MeasurementTable measurements{core_};
  SweepReader reader{core_};
};

/// Checks that a file may be copied by a program that does not serve it.
/// @throws InvalidRequest if it is no store, StorageError if it is in use under another name or has several:
///     then what the file holds under this one may be old
void check_can_be_copied(const std::filesystem::path& store);

/// Writes a consistent copy of a store, a store itself, to a file that does not exist. The store may be in
/// use by any process, which goes on.
/// @param stop  asked now and then; true ends the copying, and there is no file
/// @returns whether there is a copy
bool copy_store(const std::filesystem::path& store, const std::filesystem::path& file,
                const std::function<bool()>& stop);

}  // namespace jobs
