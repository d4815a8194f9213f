// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/measurements/measurement.h"

namespace jobs {

/// Packs the samples of a measurement:
///
///     version byte | number of runs | size of each run | runs, each as encode_trajectory() packs it
///
/// The time is the channel t_s. Unpacking gives the same numbers, bit by bit.
[[nodiscard]] std::string encode_samples(const Measurement& measurement);

/// Packed runs, parts of the blob. @throws DamagedTrajectory
[[nodiscard]] std::vector<std::string_view> split_runs(std::string_view blob);

/// Measurement as it is stored.
struct PackedMeasurement {
  std::string name;
  std::string description;  ///< JSON text of measurement_json()
  std::string samples;      ///< by encode_samples()
};

[[nodiscard]] PackedMeasurement pack(const Measurement& measurement);

/// @throws DamagedTrajectory if the parts do not belong together
[[nodiscard]] Measurement unpack(const PackedMeasurement& packed);

/// Fills in times and columns of the runs. @throws DamagedTrajectory if they do not agree with the channels
void decode_samples(std::string_view blob, Measurement& measurement);

}  // namespace jobs
