// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/store/rows.h"

namespace jobs {

/// Sweeps whose costs are read for the time left of others. Of more a sample is read: whoever asks waits for
/// it.
inline constexpr std::size_t kMostActiveSweeps = 128;

/// Sweeps that have not ended, with what is left of them.
struct ActiveSweepSample {
  std::map<std::int64_t, std::shared_ptr<const RivalSweep>> sweeps;  ///< by number
  std::map<std::string, double> cost_rates;                          ///< SweepRow::cost_rates
};

/// Keeps a sample for a second; where all sweeps are read, they are read anew each time.
class ActiveSweepCache {
 public:
  [[nodiscard]] std::shared_ptr<const ActiveSweepSample> read(const SQLite::Database& database);

 private:
  std::mutex mutex_;  // guards the rest
  std::shared_ptr<const ActiveSweepSample> kept_;
  std::chrono::steady_clock::time_point kept_until_;
};

/// The sample within one transaction, read when it is first asked for.
class ActiveSweeps {
 public:
  ActiveSweeps(const SQLite::Database& database, ActiveSweepCache& cache)
      : database_(database), cache_(cache) {}

  /// Reads what is left of a sweep that has not ended, and of those that it shares the threads with.
  void read_what_is_left(std::int64_t seq, SweepRow& row);

 private:
  const SQLite::Database& database_;
  ActiveSweepCache& cache_;
  std::shared_ptr<const ActiveSweepSample> sample_;
};

}  // namespace jobs
