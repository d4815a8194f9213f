// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace jobs {

/// Packs columns of numbers with the 24 bits of a float, for columns that are smooth most of the time:
///
///     order byte | first value, 4 bytes | width byte of each block | bits of each block
///
/// The bits of a float, read as an integer whose order is that of the numbers, change little from sample to
/// sample, and its differences of the third order less still. A block is 16 of these differences, each with
/// as many bits as the largest of them takes. The order, 0 to 4, is the one that is best on a part of the
/// blocks; before the first value stands the first value. Unpacking gives static_cast<float>(x) for every x,
/// bit by bit.
class SinglePacker {
 public:
  /// @returns bytes that are good until the next call
  [[nodiscard]] std::string_view pack(std::span<const double> column);

 private:
  // Room that every column needs.
  std::vector<std::uint32_t> values_;
  std::string packed_;
};

/// Unpacks a column from its beginning, some samples at a time. Holds one block of it.
class SingleUnpacker {
 public:
  /// @param packed  outlives this
  /// @throws DamagedTrajectory if the bytes are not those of a column of that many samples
  SingleUnpacker(std::string_view packed, std::size_t samples);

  /// Appends the next samples, at most so many.
  void append_next(std::size_t count, std::vector<double>& to);

 private:
  void unpack_block();

  std::string_view widths_;
  std::string_view bits_;
  std::size_t left_;              ///< samples that have not been appended
  unsigned char order_ = 0;
  std::size_t place_ = 0;         ///< of the next sample in the block; as many as a block has: the next block
  std::array<std::uint32_t, 20> values_{};  ///< those that differences reach back to, and those of the block
};

/// @throws DamagedTrajectory if the bytes are not those of a column of that many samples
[[nodiscard]] std::vector<double> unpack_singles(std::string_view packed, std::size_t samples);

/// Largest length of a packed column.
[[nodiscard]] std::size_t largest_packed_size(std::size_t samples);

}  // namespace jobs
