// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/analysis/quantities.h"

namespace jobs {

/// A trajectory as numpy.load reads it: one array of doubles a channel, under the channel's key. An .npz file
/// is a zip archive, here with its entries stored as they are; the same trajectory gives the same bytes.
/// @throws std::length_error if it does not fit into a zip archive of 4 GiB
[[nodiscard]] std::string to_npz(const engine::Trajectory& trajectory);

}  // namespace jobs
