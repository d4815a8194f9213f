// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/analysis/quantities.h"

namespace jobs {

/// A blob that is no trajectory, or one that was damaged.
class DamagedTrajectory : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws std::invalid_argument if the columns are not one for each channel, of one length
void check_is_table(const engine::Trajectory& trajectory);

/// A trajectory with the precision that is kept: channels marked single_precision rounded to 24 bits.
/// @throws std::invalid_argument as check_is_table does
[[nodiscard]] engine::Trajectory rounded_to_stored(engine::Trajectory trajectory);

/// Packs a trajectory:
///
///     version byte | size of header | header | one block a channel
///
/// The header and each block are zstd frames with a checksum. Channels of single precision are packed by
/// SinglePacker. A block of doubles holds the bytes of its column shuffled (all first bytes, all second
/// bytes, ...): neighbours differ in their low bytes only, so that the others compress well. A time axis k /
/// rate is stored as its rate and last value, if that reads back to the same bits. A channel whose column is
/// another one's has no block of its own. Blobs of version 1 are read, too. Decoding gives
/// rounded_to_stored(trajectory), bit by bit.
/// @throws std::invalid_argument as check_is_table does
[[nodiscard]] std::string encode_trajectory(const engine::Trajectory& trajectory);

/// Unpacks the channels that are wanted, in that order.
/// @param keys  empty: all. A key that is not there is left out
/// @throws DamagedTrajectory; sizes are checked against limits before memory is taken
[[nodiscard]] engine::Trajectory decode_trajectory(std::span<const std::byte> blob,
                                                   std::span<const std::string> keys);

/// Contents of a blob, without its columns.
[[nodiscard]] std::vector<engine::QuantityInfo> decode_channels(std::span<const std::byte> blob);

}  // namespace jobs
