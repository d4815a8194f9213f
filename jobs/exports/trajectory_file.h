// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "jobs/exports/table_column.h"
#include "jobs/trajectories/trajectory_view.h"

namespace jobs {

/// Formats of files with all trajectories of a sweep.
enum class TrajectoryFileFormat { kHdf5, kMat, kNpz };

/// Contents of such a file beside the trajectories.
struct ExportedSweep {
  std::string id, name;
  std::string program;               ///< name and version
  std::vector<TableColumn> results;  ///< table of results, a row a job
};

/// File that takes the trajectories of a sweep, one after the other. The same calls give the same bytes. All
/// members throw StorageError if the file cannot be written.
class TrajectoryFile {
 public:
  TrajectoryFile() = default;
  virtual ~TrajectoryFile() = default;
  TrajectoryFile(const TrajectoryFile&) = delete;
  TrajectoryFile& operator=(const TrajectoryFile&) = delete;

  /// @param job   name within the file, as "job_0001"
  /// @param view  has been loaded
  virtual void add(const std::string& job, const std::string& job_id, const TrajectoryView& view) = 0;
  /// To be called after the last one: without, the file is not complete.
  virtual void close() = 0;
};

/// HDF5: group "results" with a dataset a column, group "trajectories" with a group a job and a dataset a
/// channel. Datasets have the attribute "unit", those of channels are chunked and deflated.
[[nodiscard]] std::unique_ptr<TrajectoryFile> create_hdf5_file(const std::filesystem::path& file,
                                                               const ExportedSweep& sweep);
/// MAT, level 5: structs "sweep", "results" and "units", and a struct a job, whose fields are columns. Names
/// that MATLAB does not take have '_' in the place of other characters.
[[nodiscard]] std::unique_ptr<TrajectoryFile> create_mat_file(const std::filesystem::path& file,
                                                              const ExportedSweep& sweep);
/// numpy.load: arrays "results/COLUMN" and "trajectories/JOB/CHANNEL", deflated.
[[nodiscard]] std::unique_ptr<TrajectoryFile> create_npz_file(const std::filesystem::path& file,
                                                              const ExportedSweep& sweep);

/// The error of a file that could not be written. @param system_error  errno at that time
[[noreturn]] void throw_unwritten(const std::filesystem::path& file, int system_error);

}  // namespace jobs
