#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace jobs {

// The pieces that packed blobs are made of. What reads throws DamagedTrajectory when there is too little.

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

/// One zstd frame, level 1, with a checksum and its size.
[[nodiscard]] std::string compress(std::string_view bytes);

/// @param at_most  bytes that the frame may hold; one that says more is damaged
[[nodiscard]] std::string decompress(std::span<const std::byte> frame, std::size_t at_most);

/// All first bytes of the items, then all second bytes, ...
[[nodiscard]] std::string shuffle(std::string_view bytes, std::size_t item_size);
[[nodiscard]] std::string unshuffle(std::string_view bytes, std::size_t item_size);

}  // namespace jobs
