// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "engine/analysis/quantities.h"

namespace jobs {

/// A trajectory as numpy.load reads it: one array of doubles a channel, under the channel's key. An .npz file
/// is a zip archive, here with its entries stored as they are; the same trajectory gives the same bytes.
/// @throws std::length_error if it does not fit into a zip archive of 4 GiB
[[nodiscard]] std::string to_npz(const engine::Trajectory& trajectory);

/// Head of a .npy file of version 1.0 with one dimension: its size is a multiple of 64.
/// @param type  of the values, as numpy names it: "<f8", "<U12"
[[nodiscard]] std::string npy_head(std::string_view type, std::size_t values);

}  // namespace jobs
