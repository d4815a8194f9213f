// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "jobs/trajectories/trajectory_codec.h"
#include "jobs/trajectories/trajectory_query.h"

namespace jobs {

/// Part of a stored trajectory that a query wants, decoded a block of samples at a time: memory is that of
/// the packed channels, however large the numbers are. Gives the samples of read_trajectory().
class TrajectoryView {
 public:
  /// Reads the header alone.
  /// @throws InvalidRequest with every fault of the query; DamagedTrajectory
  TrajectoryView(const StoredBytes& blob, TrajectoryQuery query);

  /// Name of the numbers: equal only for equal numbers of the same query.
  [[nodiscard]] const std::string& fingerprint() const { return fingerprint_; }

  /// Reads what is wanted. @throws DamagedTrajectory
  void load(const StoredBytes& blob);

  // After load():
  [[nodiscard]] const std::vector<engine::QuantityInfo>& channels() const { return channels_; }
  [[nodiscard]] std::size_t samples() const { return samples_; }
  /// Cursor of a column. Not to outlive this.
  [[nodiscard]] std::unique_ptr<ColumnCursor> read_column(std::size_t channel) const;
  /// All of it at once.
  [[nodiscard]] engine::Trajectory read_all() const;

 private:
  void cut_times();
  void thin_out(std::size_t points);
  void keep_extremes(std::size_t channel, std::size_t points);

  TrajectoryQuery query_;
  PackedTrajectory packed_;
  std::string fingerprint_;
  std::vector<engine::QuantityInfo> channels_;
  std::size_t begin_ = 0, end_ = 0;  ///< samples between from and to
  std::vector<bool> kept_;           ///< of those, the samples that decimation keeps; empty: all
  std::size_t samples_ = 0;
};

}  // namespace jobs
