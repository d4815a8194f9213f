// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/measurement_codec.h"

#include <cstdint>
#include <utility>

#include "jobs/measurements/measurement_json.h"
#include "jobs/trajectories/byte_codec.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {
namespace {

constexpr std::uint8_t kSamplesVersion = 1;

engine::Trajectory as_trajectory(const Measurement& measurement, const MeasuredRun& run) {
  engine::Trajectory trajectory;
  trajectory.channels.push_back({.key = kTrajectoryTime, .help = "Time"});
  trajectory.columns.push_back(run.time_s);
  for (const MeasuredChannel& channel : measurement.channels)
    trajectory.channels.push_back({.key = channel.name, .help = ""});
  trajectory.columns.insert(trajectory.columns.end(), run.columns.begin(), run.columns.end());
  return trajectory;
}

}  // namespace

std::string encode_samples(const Measurement& measurement) {
  std::vector<std::string> runs;
  for (const MeasuredRun& run : measurement.runs)
    runs.push_back(encode_trajectory(as_trajectory(measurement, run)));
  ByteWriter head;
  head.number(kSamplesVersion);
  head.number(static_cast<std::uint32_t>(runs.size()));
  for (const std::string& run : runs) head.number(static_cast<std::uint64_t>(run.size()));
  std::string blob = head.bytes();
  for (const std::string& run : runs) blob += run;
  return blob;
}

std::vector<std::string_view> split_runs(std::string_view blob) {
  ByteReader reader(std::as_bytes(std::span(blob)));
  if (reader.number<std::uint8_t>() != kSamplesVersion)
    throw DamagedTrajectory("the samples are of an unknown version");
  const auto count = reader.number<std::uint32_t>();
  if (count > kMostMeasuredRuns) throw DamagedTrajectory("the samples have too many runs");
  std::vector<std::uint64_t> sizes;
  for (std::uint32_t i = 0; i < count; ++i) sizes.push_back(reader.number<std::uint64_t>());
  std::vector<std::string_view> runs;
  for (const std::uint64_t size : sizes) {
    const auto bytes = reader.take(size);
    runs.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  if (!reader.at_end()) throw DamagedTrajectory("the samples are longer than their runs");
  return runs;
}

PackedMeasurement pack(const Measurement& measurement) {
  return {.name = measurement.name,
          // Names of columns may have any bytes.
          .description =
              measurement_json(measurement).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
          .samples = encode_samples(measurement)};
}

Measurement unpack(const PackedMeasurement& packed) {
  try {
    Measurement measurement = measurement_of(nlohmann::json::parse(packed.description));
    measurement.name = packed.name;
    decode_samples(packed.samples, measurement);
    return measurement;
  } catch (const nlohmann::json::exception& error) {
    throw DamagedTrajectory(error.what());
  }
}

void decode_samples(std::string_view blob, Measurement& measurement) {
  const auto packed = split_runs(blob);
  if (packed.size() != measurement.runs.size())
    throw DamagedTrajectory("the samples have another number of runs");
  for (std::size_t r = 0; r < packed.size(); ++r) {
    auto [channels, columns] = decode_trajectory(std::as_bytes(std::span(packed[r])), {});
    if (columns.size() != measurement.channels.size() + 1)
      throw DamagedTrajectory("the samples have another number of channels");
    measurement.runs[r].time_s = std::move(columns.front());
    columns.erase(columns.begin());
    measurement.runs[r].columns = std::move(columns);
  }
}

}  // namespace jobs
