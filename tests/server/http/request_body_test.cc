// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_body.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <zlib.h>

namespace {

/// zlib's own: a gzip member, or with the default window the zlib format that "deflate" means.
std::string packed(const std::string& text, int window_bits) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::runtime_error("zlib");
  std::string out(deflateBound(&stream, text.size()) + 64, '\0');
  std::string in = text;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}
std::string gzip(const std::string& text) { return packed(text, 15 + 16); }

std::string damaged(std::string text, std::size_t from_end) {
  text[text.size() - from_end] = static_cast<char>(text[text.size() - from_end] ^ 1);
  return text;
}

const std::string kLong = [] {
  std::string text;
  for (int k = 0; k < 40'000; ++k) text += std::to_string(k);
  return text;
}();

struct Outcome {
  int status = 0;  ///< 0: the body is there
  std::string body;
};

/// Reads a body from bytes that come a few at a time, and are followed by nothing.
Outcome read(const std::string& wire, server::BodyForm form, std::size_t limit = 1'000'000, std::size_t piece = 7) {
  std::size_t place = 0;
  Outcome outcome;
  const auto fault = server::read_request_body(
      [&](char* to, std::size_t size) -> std::ptrdiff_t {
        const std::size_t n = std::min({size, piece, wire.size() - place});
        std::memcpy(to, wire.data() + place, n);
        place += n;
        return static_cast<std::ptrdiff_t>(n);
      },
      form, limit, outcome.body);
  if (fault) outcome.status = fault->status;
  return outcome;
}

Outcome read_chunked(const std::string& wire) { return read(wire, {.chunked = true}); }
Outcome read_coded(const std::string& wire, const std::string& coding, std::size_t limit = 1'000'000) {
  return read(wire, {.content_length = wire.size(), .coding = coding}, limit, 1000);
}

TEST(RequestBody, HasTheLengthThatWasAnnounced) {
  EXPECT_EQ(read("abcdef and more", {.content_length = 6}).body, "abcdef");
  EXPECT_EQ(read("", {}).status, 0);
  EXPECT_EQ(read("abc", {.content_length = 6}).status, 400);
  EXPECT_EQ(read("abcdef", {.content_length = 6}, 6).status, 0);
  EXPECT_EQ(read("abcdef", {.content_length = 6}, 5).status, 413);
}

TEST(RequestBody, ComesInChunks) {
  for (const char* const wire : {"3\r\nabc\r\n00A\r\n0123456789\r\n0\r\n\r\n", "3;name=\"value\"\r\nabc\r\na ; x\r\n0123456789\r\n0\r\n\r\n",
                                 "3\r\nabc\r\na\r\n0123456789\r\n0;last\r\nChecksum: 5\r\nX-Empty:\r\n\r\n"}) {
    EXPECT_EQ(read_chunked(wire).status, 0) << wire;
    EXPECT_EQ(read_chunked(wire).body, "abc0123456789") << wire;
  }
}

TEST(RequestBody, IsRefusedInBrokenChunks) {
  for (const std::string wire : {"", "3\r\nabc", "3\r\nabc\r\n", "3\r\nabc\r\n0\r\n", "3\r\nabcd\r\n0\r\n\r\n", "3\nabc\n0\n\n", "-3\r\nabc\r\n0\r\n\r\n", "0x3\r\nabc\r\n0\r\n\r\n",
                                 "3 abc\r\nabc\r\n0\r\n\r\n", "\r\nabc\r\n0\r\n\r\n", "fffffffffffffffff\r\nabc", "0\r\nno trailer\r\n\r\n", "0\r\n: x\r\n\r\n",
                                 "0\r\nX : y\r\n\r\n", "0\r\nX: y\r\n"})
    EXPECT_EQ(read_chunked(wire).status, 400) << wire;
  EXPECT_EQ(read_chunked("3;" + std::string(10'000, 'a') + "\r\nabc\r\n0\r\n\r\n").status, 400) << "a long extension";
}

TEST(RequestBody, IsUnpackedWithAllItsMembers) {
  EXPECT_EQ(read_coded(gzip(kLong), "gzip").body, kLong);
  EXPECT_EQ(read_coded(gzip("{\"a\": ") + gzip(kLong) + gzip("") + gzip("}"), "gzip").body, "{\"a\": " + kLong + "}");
  EXPECT_EQ(read_coded(packed(kLong, 15), "deflate").body, kLong);
  EXPECT_EQ(read_coded(gzip(std::string(16 * 1024, 'a')), "gzip").body, std::string(16 * 1024, 'a')) << "exactly one piece";
  EXPECT_EQ(read_coded("plain", "identity").body, "plain");
}

TEST(RequestBody, IsRefusedIfItIsDamaged) {
  const std::string whole = gzip("{\"sweep\": {}}");
  for (std::size_t cut = 1; cut < whole.size(); ++cut) EXPECT_EQ(read_coded(whole.substr(0, whole.size() - cut), "gzip").status, 400) << cut;
  EXPECT_EQ(read_coded(damaged(whole, 8), "gzip").status, 400) << "the checksum";
  EXPECT_EQ(read_coded(damaged(whole, 1), "gzip").status, 400) << "the length";
  EXPECT_EQ(read_coded(whole + "more", "gzip").status, 400);
  EXPECT_EQ(read_coded(whole + whole.substr(0, 12), "gzip").status, 400) << "the second member is cut";
  EXPECT_EQ(read_coded(packed("{}", 15) + packed("{}", 15), "deflate").status, 400);
  EXPECT_EQ(read_coded("{}", "gzip").status, 400);
}

TEST(RequestBody, IsBoundedAfterUnpacking) {
  const std::string bomb = gzip(std::string(2'000'000, ' '));
  EXPECT_EQ(read_coded(bomb, "gzip").status, 413);
  EXPECT_EQ(read_coded(bomb, "gzip", 2'000'000).status, 0);
  EXPECT_EQ(read_coded(gzip(std::string(600'000, ' ')) + gzip(std::string(600'000, ' ')), "gzip").status, 413);
}

}  // namespace
