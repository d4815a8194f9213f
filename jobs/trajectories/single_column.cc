// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/single_column.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <utility>

#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {
namespace {

constexpr std::size_t kBlock = 16;       // values; narrow enough that a jump makes few others wide
constexpr std::size_t kOrders = 5;
constexpr std::size_t kLead = kOrders - 1;  // values before the first that differences reach back to
constexpr std::size_t kWidths = 33;

using Block = std::array<std::uint32_t, kBlock>;

/// The bits of a float as an integer that grows with it; its own inverse.
constexpr std::uint32_t ordered(std::uint32_t bits) {
  return bits ^ (static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> 31) & 0x7fffffffU);
}

/// Small numbers of both signs as small numbers without.
constexpr std::uint32_t fold(std::uint32_t x) {
  return (x << 1U) ^ static_cast<std::uint32_t>(static_cast<std::int32_t>(x) >> 31);
}
constexpr std::uint32_t unfold(std::uint32_t x) { return (x >> 1U) ^ (0U - (x & 1U)); }

/// The folded difference of that order, all of it modulo 2^32.
/// @param x  the value, with kLead others before it
template <std::size_t order>
std::uint32_t difference(const std::uint32_t* x) {
  if constexpr (order == 0) return fold(x[0]);
  if constexpr (order == 1) return fold(x[0] - x[-1]);
  if constexpr (order == 2) return fold(x[0] - 2 * x[-1] + x[-2]);
  if constexpr (order == 3) return fold(x[0] - 3 * (x[-1] - x[-2]) - x[-3]);
  if constexpr (order == 4) return fold(x[0] - 4 * (x[-1] + x[-3]) + 6 * x[-2] + x[-4]);
}

template <std::size_t order>
void take_differences(const std::uint32_t* x, Block& block) {
  for (std::size_t i = 0; i < kBlock; ++i) block[i] = difference<order>(x + i);
}

constexpr auto kTakeDifferences = [] {
  std::array<void (*)(const std::uint32_t*, Block&), kOrders> table{};
  [&]<std::size_t... order>(std::index_sequence<order...>) {
    ((table[order] = &take_differences<order>), ...);
  }
  (std::make_index_sequence<kOrders>{});
  return table;
}();

std::size_t width_of(const Block& block) {
  std::uint32_t all = 0;
  for (const std::uint32_t x : block) all |= x;
  return static_cast<std::size_t>(std::bit_width(all));
}

/// Writes the lowest `width` bits of each value: 2 width bytes. With the width known, the compiler makes a
/// straight line of it.
template <std::size_t width>
void put_bits(const Block& block, char* to) {
  std::uint64_t word = 0;
  std::size_t used = 0;
  for (const std::uint32_t x : block) {
    word |= std::uint64_t{x} << used;
    used += width;
    if (used >= 32) {
      std::memcpy(to, &word, 4);
      to += 4;
      word >>= 32U;
      used -= 32;
    }
  }
  std::memcpy(to, &word, used / 8);
}

template <std::size_t width>
void get_bits(const char* from, Block& block) {
  std::array<std::uint32_t, kBlock + 1> words{};
  std::memcpy(words.data(), from, 2 * width);
  constexpr std::uint64_t mask = (std::uint64_t{1} << width) - 1;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const std::size_t bit = i * width;
    const std::uint64_t both = words[bit / 32] | std::uint64_t{words[bit / 32 + 1]} << 32U;
    block[i] = static_cast<std::uint32_t>((both >> (bit % 32)) & mask);
  }
}

constexpr auto kPutBits = [] {
  std::array<void (*)(const Block&, char*), kWidths> table{};
  [&]<std::size_t... width>(std::index_sequence<width...>) { ((table[width] = &put_bits<width>), ...); }
  (std::make_index_sequence<kWidths>{});
  return table;
}();

constexpr auto kGetBits = [] {
  std::array<void (*)(const char*, Block&), kWidths> table{};
  [&]<std::size_t... width>(std::index_sequence<width...>) { ((table[width] = &get_bits<width>), ...); }
  (std::make_index_sequence<kWidths>{});
  return table;
}();

std::size_t count_blocks(std::size_t samples) { return (samples + kBlock - 1) / kBlock; }

/// Writes the ordered integers after kLead times the first of them; then as many times the last as fill the
/// last block.
void put_ordered(std::span<const double> column, std::vector<std::uint32_t>& values) {
  const std::size_t samples = column.size();
  values.resize(kLead + count_blocks(samples) * kBlock);
  std::uint32_t* const to = values.data() + kLead;
  for (std::size_t k = 0; k < samples; ++k)
    to[k] = ordered(std::bit_cast<std::uint32_t>(static_cast<float>(column[k])));
  std::fill_n(values.begin(), kLead, to[0]);
  std::fill(to + samples, values.data() + values.size(), to[samples - 1]);
}

std::size_t find_best_order(const std::vector<std::uint32_t>& values, std::size_t blocks) {
  constexpr std::size_t kLooks = 20;
  std::array<std::size_t, kOrders> bits{};
  Block block;
  for (std::size_t b = 0; b < blocks; b += std::max<std::size_t>(1, blocks / kLooks)) {
    for (std::size_t order = 0; order < kOrders; ++order) {
      kTakeDifferences[order](values.data() + kLead + b * kBlock, block);
      bits[order] += width_of(block);
    }
  }
  return static_cast<std::size_t>(std::ranges::min_element(bits) - bits.begin());
}

/// Sums up the differences in place.
/// @param x  with kLead values before it
template <std::size_t order>
void add_up(const Block& block, std::uint32_t* x) {
  for (std::size_t i = 0; i < kBlock; ++i, ++x) {
    const std::uint32_t step = unfold(block[i]);
    if constexpr (order == 0) x[0] = step;
    if constexpr (order == 1) x[0] = step + x[-1];
    if constexpr (order == 2) x[0] = step + 2 * x[-1] - x[-2];
    if constexpr (order == 3) x[0] = step + 3 * (x[-1] - x[-2]) + x[-3];
    if constexpr (order == 4) x[0] = step + 4 * (x[-1] + x[-3]) - 6 * x[-2] - x[-4];
  }
}

constexpr auto kAddUp = [] {
  std::array<void (*)(const Block&, std::uint32_t*), kOrders> table{};
  [&]<std::size_t... order>(std::index_sequence<order...>) { ((table[order] = &add_up<order>), ...); }
  (std::make_index_sequence<kOrders>{});
  return table;
}();

/// Packs all blocks of a column. Returns the end of the bits.
template <std::size_t order>
char* pack_blocks(const std::uint32_t* x, std::size_t blocks, char* widths, char* bits) {
  Block block;
  for (std::size_t b = 0; b < blocks; ++b) {
    take_differences<order>(x + b * kBlock, block);
    const std::size_t width = width_of(block);
    widths[b] = static_cast<char>(width);
    kPutBits[width](block, bits);
    bits += 2 * width;
  }
  return bits;
}

constexpr auto kPack = [] {
  std::array<char* (*)(const std::uint32_t*, std::size_t, char*, char*), kOrders> table{};
  [&]<std::size_t... order>(std::index_sequence<order...>) { ((table[order] = &pack_blocks<order>), ...); }
  (std::make_index_sequence<kOrders>{});
  return table;
}();

constexpr std::size_t kHeadSize = 1 + sizeof(std::uint32_t);

/// Packed blocks of a column that repeats its first value.
void pack_constant(double value, std::size_t blocks, std::string& packed) {
  const std::uint32_t first = ordered(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  packed.assign(kHeadSize + blocks, '\0');  // blocks without bits
  packed[0] = first == 0 ? 0 : 1;           // the least order whose differences are 0
  std::memcpy(packed.data() + 1, &first, sizeof first);
}

unsigned char read_order(std::string_view packed) {
  const auto order = static_cast<unsigned char>(packed[0]);
  if (order >= kOrders) throw DamagedTrajectory("a column of the trajectory is packed in an unknown way");
  return order;
}

/// Bytes of all blocks together. @param widths  of the blocks
std::size_t count_bit_bytes(std::string_view widths) {
  std::size_t bytes = 0;
  for (const char width : widths) {
    if (static_cast<unsigned char>(width) >= kWidths)
      throw DamagedTrajectory("a column of the trajectory has a wrong length");
    bytes += 2U * static_cast<unsigned char>(width);
  }
  return bytes;
}

bool is_constant(std::span<const double> column) {
  // Each equals the next
  return std::memcmp(column.data(), column.data() + 1, (column.size() - 1) * sizeof(double)) == 0;
}

}  // namespace

std::size_t largest_packed_size(std::size_t samples) {
  return kHeadSize + count_blocks(samples) * (1 + sizeof(Block));
}

std::string_view SinglePacker::pack(std::span<const double> column) {
  if (column.empty()) return {};
  const std::size_t blocks = count_blocks(column.size());
  if (is_constant(column)) {
    pack_constant(column.front(), blocks, packed_);
    return packed_;
  }
  put_ordered(column, values_);
  const std::size_t order = find_best_order(values_, blocks);
  packed_.resize(largest_packed_size(column.size()));
  packed_[0] = static_cast<char>(order);
  std::memcpy(packed_.data() + 1, values_.data(), sizeof(std::uint32_t));
  char* const widths = packed_.data() + kHeadSize;
  char* const bits_end = kPack[order](values_.data() + kLead, blocks, widths, widths + blocks);
  return {packed_.data(), static_cast<std::size_t>(bits_end - packed_.data())};
}

SingleUnpacker::SingleUnpacker(std::string_view packed, std::size_t samples)
    : left_(samples), place_(kBlock) {
  static_assert(std::tuple_size_v<decltype(values_)> == kLead + kBlock);
  if (samples == 0 && packed.empty()) return;
  const std::size_t blocks = count_blocks(samples);
  if (samples == 0 || packed.size() < kHeadSize + blocks)
    throw DamagedTrajectory("a column of the trajectory has a wrong length");
  order_ = read_order(packed);
  std::uint32_t first = 0;
  std::memcpy(&first, packed.data() + 1, sizeof first);
  values_.fill(first);
  widths_ = packed.substr(kHeadSize, blocks);
  bits_ = packed.substr(kHeadSize + blocks);
  if (count_bit_bytes(widths_) != bits_.size())
    throw DamagedTrajectory("a column of the trajectory has a wrong length");
}

void SingleUnpacker::unpack_block() {
  std::copy_n(values_.end() - kLead, kLead, values_.begin());
  const auto width = static_cast<unsigned char>(widths_.front());
  Block block;
  kGetBits[width](bits_.data(), block);
  widths_.remove_prefix(1);
  bits_.remove_prefix(2U * width);
  kAddUp[order_](block, values_.data() + kLead);
  place_ = 0;
}

void SingleUnpacker::append_next(std::size_t count, std::vector<double>& to) {
  for (count = std::min(count, left_), left_ -= count; count > 0; --count) {
    if (place_ == kBlock) unpack_block();
    to.push_back(static_cast<double>(std::bit_cast<float>(ordered(values_[kLead + place_++]))));
  }
}

std::vector<double> unpack_singles(std::string_view packed, std::size_t samples) {
  SingleUnpacker unpacker(packed, samples);
  std::vector<double> column;
  column.reserve(samples);
  unpacker.append_next(samples, column);
  return column;
}

}  // namespace jobs
