// SPDX-License-Identifier: Apache-2.0
#include "jobs/exports/write_trajectories.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "jobs/base/errors.h"
#include "jobs/base/size_text.h"
#include "jobs/results/resource_json.h"
#include "jobs/store/store_lock.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {
namespace {

constexpr double kMostMatBytes = 2147483648.0;  // of one variable of level 5

/// Trajectory of a job, which is read twice: to know how much there is, and to write it.
struct StoredJob {
  std::string name, id;
};

/// Parts of the sweep's trajectories, by their headers.
struct SweepContents {
  std::vector<StoredJob> jobs;
  std::vector<engine::QuantityInfo> channels;  ///< of any job
  double bytes = 0.0;                          ///< of all numbers, at most
};

std::string name_of_job(std::size_t row) {
  constexpr std::size_t kDigits = 4;
  const std::string digits = std::to_string(row + 1);
  return "job_" + std::string(kDigits - std::min(kDigits, digits.size()), '0') + digits;
}

/// @throws StorageError that names the job if its trajectory is damaged
template <typename Use>
bool read_stored(const SweepReader& reader, const std::string& job_id, const Use& use) {
  try {
    return reader.read_trajectory(job_id, use);
  } catch (const DamagedTrajectory& damage) {
    throw StorageError("the trajectory of " + job_id + " cannot be read: " + damage.what());
  }
}

bool is_wanted(const TrajectoryQuery& query, const std::string& channel) {
  return query.channels.empty() || channel == "t_s" ||
         std::ranges::find(query.channels, channel) != query.channels.end();
}

/// Number of samples between the times of a query.
std::size_t samples_between(const StoredBytes& blob, const TrajectoryQuery& query) {
  TrajectoryView times(blob, {.channels = {"t_s"}, .from = query.from, .to = query.to});
  times.load(blob);
  return times.samples();
}

void add_job(const StoredBytes& blob, const TrajectoryExport& wanted, SweepContents& contents) {
  std::size_t channels = 0;
  for (engine::QuantityInfo& channel : PackedTrajectory(blob).channels()) {
    if (is_wanted(wanted.query, channel.key)) ++channels;
    const bool is_new = std::ranges::find(contents.channels, channel.key, &engine::QuantityInfo::key) ==
                        contents.channels.end();
    if (is_new) contents.channels.push_back(std::move(channel));
  }
  const double bytes = static_cast<double>(sizeof(double) * samples_between(blob, wanted.query) * channels);
  if (wanted.format == TrajectoryFileFormat::kMat && bytes >= kMostMatBytes)
    throw InvalidRequest(std::vector<Fault>{
        {"/format",
         "a MAT file holds 2 GiB of a job at most; take h5, fewer channels or a part of the time"}});
  contents.bytes += bytes;
}

/// @returns empty if stop() said so
std::optional<SweepContents> read_contents(const SweepReader& reader, const SweepResults& sweep,
                                           const TrajectoryExport& wanted,
                                           const std::function<bool()>& stop) {
  check_query({.channels = {}, .from = wanted.query.from, .to = wanted.query.to}, {});
  SweepContents contents;
  for (std::size_t row = 0; row < sweep.rows.size(); ++row) {
    if (stop()) return std::nullopt;
    const std::string& id = sweep.rows[row].job_id;
    const bool has_one =
        read_stored(reader, id, [&](const StoredBytes& blob) { add_job(blob, wanted, contents); });
    if (has_one) contents.jobs.push_back({name_of_job(row), id});
  }
  return contents;
}

/// The part of a query that a job has.
TrajectoryQuery query_of(const TrajectoryQuery& wanted, const StoredBytes& blob) {
  TrajectoryQuery query = wanted;
  if (query.channels.empty()) return query;
  const std::vector<engine::QuantityInfo> channels = PackedTrajectory(blob).channels();
  std::erase_if(query.channels, [&](const std::string& key) {
    return std::ranges::find(channels, key, &engine::QuantityInfo::key) == channels.end();
  });
  if (query.channels.empty()) query.channels.emplace_back("t_s");  // none would be all
  return query;
}

void check_has_jobs(const SweepContents& contents, const std::string& sweep_id) {
  if (contents.jobs.empty())
    throw WrongState("no job of sweep " + sweep_id +
                     " has a trajectory; one with \"keep\": \"metrics\" has none");
}

/// @param reserve_bytes  that stay free on the disk for others
void check_room(const std::filesystem::path& file, double bytes, std::int64_t reserve_bytes) {
  std::error_code unknown;
  const auto space = std::filesystem::space(std::filesystem::absolute(file).parent_path(), unknown);
  const auto reserve = static_cast<double>(reserve_bytes);
  if (unknown || static_cast<double>(space.available) > bytes + reserve) return;
  throw StoreLimitReached("the file may take " + size_text(bytes) + " and the disk has " +
                          size_text(static_cast<double>(space.available)) + " left" +
                          (reserve > 0.0 ? ", of which " + size_text(reserve) + " are kept free" : "") +
                          "; ask for fewer channels, or for a part of the time");
}

std::unique_ptr<TrajectoryFile> create_file(TrajectoryFileFormat format, const std::filesystem::path& file,
                                            const ExportedSweep& sweep) {
  if (format == TrajectoryFileFormat::kNpz) return create_npz_file(file, sweep);
  return format == TrajectoryFileFormat::kMat ? create_mat_file(file, sweep) : create_hdf5_file(file, sweep);
}

ExportedSweep make_exported_sweep(const SweepResults& sweep, const std::string& program) {
  return {.id = sweep.sweep.id,
          .name = sweep.sweep.name,
          .program = program,
          .results = to_columns(result_table(sweep, {}))};
}

void write_job(const SweepReader& reader, const StoredJob& job, const TrajectoryQuery& query,
               TrajectoryFile& file) {
  read_stored(reader, job.id, [&](const StoredBytes& blob) {
    TrajectoryView view(blob, query_of(query, blob));
    view.load(blob);
    file.add(job.name, job.id, view);
  });
}

}  // namespace

void throw_unwritten(const std::filesystem::path& file, int system_error) {
  throw StorageError("cannot write " + file.string(), 0, disk_state(system_error));
}

bool write_trajectories(const SweepReader& reader, const SweepResults& sweep, const TrajectoryExport& wanted,
                        const std::string& program, const std::filesystem::path& file,
                        std::int64_t reserve_bytes, const std::function<bool()>& stop) {
  const auto contents = read_contents(reader, sweep, wanted, stop);
  if (!contents) return false;
  check_has_jobs(*contents, sweep.sweep.id);
  check_query(wanted.query, contents->channels);
  check_room(file, contents->bytes, reserve_bytes);
  const auto written = create_file(wanted.format, file, make_exported_sweep(sweep, program));
  for (const StoredJob& job : contents->jobs) {
    if (stop()) return false;
    write_job(reader, job, wanted.query, *written);
  }
  written->close();
  return true;
}

}  // namespace jobs
