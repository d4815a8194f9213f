// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct ZSTD_CCtx_s;

namespace jobs {

// The pieces that packed blobs are made of. Readers throw DamagedTrajectory when there are too few bytes.

static_assert(std::endian::native == std::endian::little, "blobs are little-endian");

/// Appends numbers and short texts.
class ByteWriter {
 public:
  template <typename T>
  void number(T value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void text(std::string_view text);  ///< at most 65535 bytes
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <typename T>
  [[nodiscard]] T number() {
    T value;
    copy(&value, sizeof value);
    return value;
  }
  [[nodiscard]] std::string text();
  [[nodiscard]] std::span<const std::byte> take(std::size_t size);
  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  void copy(void* to, std::size_t size);

  std::span<const std::byte> rest_;
};

/// Effort of the search for repetitions.
enum class Effort {
  kFull,   ///< level 1
  kLittle  ///< of bytes that are packed already: long runs are found, the checksum is what matters
};

/// Makes zstd frames, each with a checksum and its size.
class Compressor {
 public:
  Compressor();
  /// Appends a frame. Returns its size.
  std::size_t append_frame(std::string_view bytes, Effort effort, std::string& to);

 private:
  std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s*)> context_;
  std::string frame_;  // room for one, so that none need be made for each
};

/// @param at_most  bytes that the frame may hold; one that says more is damaged
[[nodiscard]] std::string decompress(std::span<const std::byte> frame, std::size_t at_most);

/// The most bytes that the head of a frame takes.
inline constexpr std::size_t kLargestFrameHead = 18;
/// Size of what a frame holds, as its head says. @param at_most  as decompress() has it
[[nodiscard]] std::size_t decompressed_size(std::span<const std::byte> head, std::size_t at_most);
/// @param to  of that size
void decompress_to(std::span<const std::byte> frame, std::span<char> to);

/// All first bytes of the items, then all second bytes, ...
[[nodiscard]] std::string shuffle(std::string_view bytes, std::size_t item_size);
[[nodiscard]] std::string unshuffle(std::string_view bytes, std::size_t item_size);

}  // namespace jobs
