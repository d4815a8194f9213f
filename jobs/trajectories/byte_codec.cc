// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/byte_codec.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>

#include <zstd.h>

#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {

void ByteWriter::text(std::string_view text) {
  if (text.size() > std::numeric_limits<std::uint16_t>::max())
    throw std::invalid_argument("a text of a trajectory is too long");
  number(static_cast<std::uint16_t>(text.size()));
  bytes_.append(text);
}

std::string ByteReader::text() {
  const auto bytes = take(number<std::uint16_t>());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> ByteReader::take(std::size_t size) {
  if (size > rest_.size()) throw DamagedTrajectory("the trajectory ends too early");
  const auto taken = rest_.first(size);
  rest_ = rest_.subspan(size);
  return taken;
}

void ByteReader::copy(void* to, std::size_t size) { std::memcpy(to, take(size).data(), size); }

Compressor::Compressor() : context_(ZSTD_createCCtx(), &ZSTD_freeCCtx) {
  if (!context_) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 1);
}

std::size_t Compressor::append_frame(std::string_view bytes, Effort effort, std::string& to) {
  // Negative levels are zstd's fast ones: the lower, the faster.
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, effort == Effort::kFull ? 1 : -100);
  frame_.resize(std::max(frame_.size(), ZSTD_compressBound(bytes.size())));
  const std::size_t size =
      ZSTD_compress2(context_.get(), frame_.data(), frame_.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  to.append(frame_, 0, size);
  return size;
}

std::size_t decompressed_size(std::span<const std::byte> head, std::size_t at_most) {
  const unsigned long long size = ZSTD_getFrameContentSize(head.data(), head.size());
  // The two error codes are the largest numbers there are.
  if (size > at_most) throw DamagedTrajectory("a block of the trajectory has a wrong size");
  return static_cast<std::size_t>(size);
}

void decompress_to(std::span<const std::byte> frame, std::span<char> to) {
  const std::size_t done = ZSTD_decompress(to.data(), to.size(), frame.data(), frame.size());
  if (ZSTD_isError(done) != 0 || done != to.size())
    throw DamagedTrajectory("a block of the trajectory is damaged");
}

std::string decompress(std::span<const std::byte> frame, std::size_t at_most) {
  std::string bytes(decompressed_size(frame, at_most), '\0');
  decompress_to(frame, bytes);
  return bytes;
}

std::string shuffle(std::string_view bytes, std::size_t item_size) {
  const std::size_t count = bytes.size() / item_size;
  std::string shuffled(bytes.size(), '\0');
  for (std::size_t b = 0; b < item_size; ++b) {
    for (std::size_t i = 0; i < count; ++i) shuffled[b * count + i] = bytes[i * item_size + b];
  }
  return shuffled;
}

std::string unshuffle(std::string_view bytes, std::size_t item_size) {
  const std::size_t count = bytes.size() / item_size;
  std::string plain(bytes.size(), '\0');
  for (std::size_t b = 0; b < item_size; ++b) {
    for (std::size_t i = 0; i < count; ++i) plain[i * item_size + b] = bytes[b * count + i];
  }
  return plain;
}

}  // namespace jobs
