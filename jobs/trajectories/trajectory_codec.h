// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/analysis/quantities.h"
#include "jobs/base/large_buffer.h"

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

/// Blob that is read a part at a time.
struct StoredBytes {
  std::size_t size = 0;
  std::function<void(std::size_t offset, std::span<char> to)> read_to;

  [[nodiscard]] std::string read(std::size_t offset, std::size_t length) const {
    std::string bytes(length, '\0');
    read_to(offset, bytes);
    return bytes;
  }
};

/// Reads a column from its beginning, some samples at a time.
class ColumnCursor {
 public:
  virtual ~ColumnCursor() = default;
  /// Appends the next samples, at most so many.
  virtual void append_next(std::size_t count, std::vector<double>& to) = 0;
};

/// Trajectory as it is stored: of a long one, a small part of the size of its numbers.
class PackedTrajectory {
 public:
  /// Reads the header alone. @throws DamagedTrajectory
  explicit PackedTrajectory(const StoredBytes& blob);

  [[nodiscard]] std::size_t samples() const { return samples_; }
  [[nodiscard]] std::vector<engine::QuantityInfo> channels() const;

  /// Keeps the wanted channels, in that order. @param keys  empty: all. A key that is not there is left out
  void select(std::span<const std::string> keys);
  /// Checksums of the channels, as the blob holds them, with the header: equal for equal numbers.
  [[nodiscard]] std::string checksums(const StoredBytes& blob) const;
  /// Reads the columns, packed. @throws DamagedTrajectory
  void load(const StoredBytes& blob);
  /// After load(). Not to outlive this.
  [[nodiscard]] std::unique_ptr<ColumnCursor> read_column(std::size_t channel) const;

 private:
  /// Channel in the header, and its column in columns_ once it has been loaded, which copies share.
  struct Channel {
    engine::QuantityInfo info;
    std::uint8_t encoding = 0;
    std::size_t offset = 0, size = 0;  ///< of its frame in the blob
    std::string_view column{};
  };

  /// Size of a channel's column that has been taken out of its frame.
  [[nodiscard]] std::size_t find_column_size(const StoredBytes& blob, const Channel& channel) const;

  std::size_t samples_ = 0;
  std::string header_;  ///< packed
  std::vector<Channel> channels_;
  std::shared_ptr<const LargeBuffer> columns_;
};

}  // namespace jobs
