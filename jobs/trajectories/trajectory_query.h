// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/analysis/quantities.h"

namespace jobs {

/// Query of a trajectory.
struct TrajectoryQuery {
  std::vector<std::string> channels;  ///< empty: all; t_s always comes first
  std::optional<double> from, to;     ///< [s], both included
  std::optional<std::size_t> points{};  ///< at most so many samples, see decimate(); empty: all
};

/// Checks a query against the channels that there are. @throws InvalidRequest with every fault
void check_query(const TrajectoryQuery& query, const std::vector<engine::QuantityInfo>& channels);

/// t_s first, then the channels that are asked for, each once; empty for all.
[[nodiscard]] std::vector<std::string> wanted_channels(const std::vector<std::string>& asked);

/// The part of a stored trajectory that is wanted.
/// @param blob  as encode_trajectory makes it
/// @throws InvalidRequest with every fault of the query; DamagedTrajectory
[[nodiscard]] engine::Trajectory read_trajectory(std::span<const std::byte> blob,
                                                 const TrajectoryQuery& query);

}  // namespace jobs
