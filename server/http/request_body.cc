// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_body.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <new>
#include <string_view>

#include <zlib.h>

namespace server {

namespace {

constexpr std::size_t kPieceBytes = 16 * 1024;
constexpr std::size_t kLineBytes = 4096;  // of the size of a chunk with its extensions, and of a trailer

enum class BodyState { kGood, kBroken, kTooLarge };

/// Decodes pieces of a body and appends them.
class BodyDecoder {
 public:
  BodyDecoder(const std::string& coding, std::size_t most_bytes, std::string& body)
      : several_members_(coding == "gzip"), most_bytes_(most_bytes), body_(body) {
    constexpr int kGzipOrZlib = 15 + 32;
    packed_ = coding == "gzip" || coding == "deflate";
    if (packed_ && inflateInit2(&zlib_, kGzipOrZlib) != Z_OK) throw std::bad_alloc();
  }
  ~BodyDecoder() {
    if (packed_) inflateEnd(&zlib_);
  }
  BodyDecoder(const BodyDecoder&) = delete;
  BodyDecoder& operator=(const BodyDecoder&) = delete;

  [[nodiscard]] BodyState add(std::string_view piece) {
    if (!packed_) return append(piece);
    zlib_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
    zlib_.avail_in = static_cast<uInt>(piece.size());
    while (zlib_.avail_in > 0 || out_was_full_) {
      if (at_member_end_ && !begin_next_member()) return BodyState::kBroken;
      if (const BodyState state = inflate_some(); state != BodyState::kGood) return state;
    }
    return BodyState::kGood;
  }

  /// @returns whether what was added is a whole body: the checksum stands at its end
  [[nodiscard]] bool is_complete() const { return !packed_ || at_member_end_ || !begun_; }

 private:
  [[nodiscard]] BodyState append(std::string_view text) {
    if (text.size() > most_bytes_ - body_.size()) return BodyState::kTooLarge;
    body_.append(text);
    return BodyState::kGood;
  }

  [[nodiscard]] bool begin_next_member() {
    at_member_end_ = false;
    return several_members_ && inflateReset(&zlib_) == Z_OK;
  }

  [[nodiscard]] BodyState inflate_some() {
    begun_ = true;
    std::array<char, kPieceBytes> out;
    zlib_.next_out = reinterpret_cast<Bytef*>(out.data());
    zlib_.avail_out = static_cast<uInt>(out.size());
    const int result = inflate(&zlib_, Z_NO_FLUSH);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    // No progress is possible only after a full buffer that held all there was.
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) return BodyState::kBroken;
    out_was_full_ = zlib_.avail_out == 0 && result == Z_OK;
    at_member_end_ = result == Z_STREAM_END;
    return append({out.data(), out.size() - zlib_.avail_out});
  }

  bool packed_ = false;
  bool several_members_;
  bool begun_ = false;
  bool at_member_end_ = false;
  bool out_was_full_ = false;  ///< there may be more of what has been taken in
  z_stream zlib_{};
  std::size_t most_bytes_;
  std::string& body_;
};

/// Reads a body piece by piece; a member function a part of its form.
class BodyReading {
 public:
  BodyReading(const ReadBytes& read, BodyDecoder& decoder) : read_(read), decoder_(decoder) {}

  [[nodiscard]] BodyState read_bytes(std::size_t count) {
    std::array<char, kPieceBytes> piece;
    while (count > 0) {
      const std::ptrdiff_t got = read_(piece.data(), std::min(count, piece.size()));
      if (got <= 0) return BodyState::kBroken;
      count -= static_cast<std::size_t>(got);
      const BodyState state = decoder_.add({piece.data(), static_cast<std::size_t>(got)});
      if (state != BodyState::kGood) return state;
    }
    return BodyState::kGood;
  }

  [[nodiscard]] BodyState read_chunks() {
    for (std::string line;;) {
      if (!read_line(line)) return BodyState::kBroken;
      std::size_t size = 0;
      const char* const end = line.data() + line.size();
      const auto parsed = std::from_chars(line.data(), end, size, 16);
      // An extension of the chunk may follow, after blanks.
      const auto rest = std::string_view(parsed.ptr, end).find_first_not_of(" \t");
      const bool good =
          parsed.ec == std::errc{} && (rest == std::string_view::npos || parsed.ptr[rest] == ';');
      if (!good) return BodyState::kBroken;
      if (size == 0) return read_trailers() ? BodyState::kGood : BodyState::kBroken;
      if (const BodyState state = read_bytes(size); state != BodyState::kGood) return state;
      if (!read_line(line) || !line.empty()) return BodyState::kBroken;
    }
  }

 private:
  [[nodiscard]] bool read_trailers() {
    for (std::string line;;) {
      if (!read_line(line)) return false;
      if (line.empty()) return true;
      const auto colon = line.find(':');
      if (colon == std::string::npos || colon == 0 || line.find_first_of(" \t") < colon) return false;
    }
  }

  /// Reads up to the next line end, CR LF, which is left out.
  [[nodiscard]] bool read_line(std::string& line) {
    line.clear();
    for (char c = 0; read_(&c, 1) == 1;) {
      if (line.size() > kLineBytes) return false;
      if (c == '\n') {
        if (!line.ends_with('\r')) return false;
        line.pop_back();
        return line.find('\r') == std::string::npos;
      }
      line += c;
    }
    return false;
  }

  const ReadBytes& read_;
  BodyDecoder& decoder_;
};

}  // namespace

std::optional<Refusal> read_request_body(const ReadBytes& read, const BodyForm& form, std::size_t body_bytes,
                                         std::string& body) {
  BodyDecoder decoder(form.coding, body_bytes, body);
  BodyReading reading(read, decoder);
  const BodyState state = form.chunked ? reading.read_chunks() : reading.read_bytes(form.content_length);
  if (state == BodyState::kTooLarge)
    return Refusal{413, "the body is larger than " + std::to_string(body_bytes) + " bytes"};
  if (state == BodyState::kBroken || !decoder.is_complete())
    return Refusal{400, "the body is incomplete, malformed or did not come in time"};
  return std::nullopt;
}

}  // namespace server
