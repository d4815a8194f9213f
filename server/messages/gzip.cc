// SPDX-License-Identifier: Apache-2.0
#include "server/messages/gzip.h"

#include <zlib.h>

#include <new>
#include <stdexcept>

namespace server {

namespace {

constexpr int kGzipHeader = 16;  // added to the size of the window, it makes zlib expect one

}  // namespace

std::string gunzip(std::string_view packed, std::size_t size) {
  std::string text(size, '\0');
  z_stream stream{};
  if (::inflateInit2(&stream, MAX_WBITS + kGzipHeader) != Z_OK) throw std::bad_alloc();
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  const int result = ::inflate(&stream, Z_FINISH);
  ::inflateEnd(&stream);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  const bool complete = result == Z_STREAM_END && stream.avail_in == 0 && stream.avail_out == 0;
  if (!complete) throw std::runtime_error("a packed text is damaged, or of another size");
  return text;
}

}  // namespace server
