// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "jobs/exports/trajectory_file.h"
#include "jobs/store/rows.h"
#include "jobs/store/sweep_reader.h"
#include "jobs/trajectories/trajectory_query.h"

namespace jobs {

/// Trajectories that are wanted in one file.
struct TrajectoryExport {
  TrajectoryFileFormat format = TrajectoryFileFormat::kHdf5;
  TrajectoryQuery query{};  ///< of each job; a channel that a job does not have is left out
};

/// Writes the results and trajectories of a sweep, a job at a time. Job k of the table of results is "job_k",
/// from "job_0001"; those without a trajectory are in the table alone. The same jobs give the same bytes.
/// @param program  name and version
/// @param reserve_bytes  that stay free on the disk for others
/// @param stop     asked before each job
/// @returns false if stop() said so; the file is then not complete
/// @throws InvalidRequest if the query is faulty or no job has one of its channels; WrongState if no job has
/// a
///     trajectory; StorageError if the disk has no room, or a trajectory cannot be read
bool write_trajectories(const SweepReader& reader, const SweepResults& sweep, const TrajectoryExport& wanted,
                        const std::string& program, const std::filesystem::path& file,
                        std::int64_t reserve_bytes, const std::function<bool()>& stop);

}  // namespace jobs
