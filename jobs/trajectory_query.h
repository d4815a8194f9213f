#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "jobs/service.h"

namespace jobs {

/// The part of a stored trajectory that is wanted.
/// @param blob  as encode_trajectory makes it
/// @throws InvalidRequest with every fault of the query; DamagedTrajectory
[[nodiscard]] engine::Trajectory read_trajectory(std::span<const std::byte> blob, const TrajectoryQuery& query);

}  // namespace jobs
