// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/zip_archive.h"

#include <new>

#include <zlib.h>

#include "jobs/measurements/check_measurement.h"

namespace jobs {
namespace {

constexpr std::size_t kEndBytes = 22, kDirectoryLineBytes = 46, kLocalHeaderBytes = 30;
constexpr std::string_view kEndMark = "PK\x05\x06", kDirectoryMark = "PK\x01\x02", kLocalMark = "PK\x03\x04";
constexpr std::size_t kMostEntries = 1000;

[[noreturn]] void refuse_archive(const std::string& why) {
  refuse_body("the file is no NPZ archive that can be read: " + why);
}

/// Part of the archive. @throws InvalidRequest if it lies beyond the end
std::string_view part(std::string_view archive, std::size_t offset, std::size_t size) {
  if (offset > archive.size() || size > archive.size() - offset) refuse_archive("it ends too early");
  return archive.substr(offset, size);
}

/// Little-endian number of 2 or 4 bytes.
std::uint32_t little_endian_at(std::string_view bytes, std::size_t offset, std::size_t size) {
  std::uint32_t number = 0;
  for (std::size_t i = size; i-- > 0;)
    number = (number << 8U) | static_cast<unsigned char>(bytes[offset + i]);
  return number;
}

/// End record of the archive, which a comment may follow.
std::string_view find_end(std::string_view archive) {
  constexpr std::size_t kLongestComment = 65535;
  if (archive.size() < kEndBytes) refuse_archive("it is too short");
  for (std::size_t comment = 0; comment <= kLongestComment; ++comment) {
    if (archive.size() < kEndBytes + comment) break;
    const std::string_view end = archive.substr(archive.size() - kEndBytes - comment);
    if (end.starts_with(kEndMark) && little_endian_at(end, 20, 2) == comment) return end.substr(0, kEndBytes);
  }
  refuse_archive("its directory is missing");
}

void check_end_record(std::string_view end) {
  const std::size_t count = little_endian_at(end, 10, 2);
  if (little_endian_at(end, 4, 4) != 0 || little_endian_at(end, 8, 2) != count)
    refuse_archive("it has several disks");
  if (count > kMostEntries) refuse_archive("it has more than " + std::to_string(kMostEntries) + " arrays");
}

/// Packed bytes of an entry, which follow its local header.
std::string_view find_packed(std::string_view archive, std::size_t header_offset, const ZipEntry& entry) {
  const std::string_view header = part(archive, header_offset, kLocalHeaderBytes);
  if (!header.starts_with(kLocalMark))
    refuse_archive("the header of " + quoted_text(entry.name) + " is missing");
  const std::size_t name_size = little_endian_at(header, 26, 2);
  if (part(archive, header_offset + kLocalHeaderBytes, name_size) != entry.name)
    refuse_archive("header and directory disagree on the name of " + quoted_text(entry.name));
  const std::size_t extra_size = little_endian_at(header, 28, 2);
  return part(archive, header_offset + kLocalHeaderBytes + name_size + extra_size, entry.packed_size);
}

void check_entry(const ZipEntry& entry, std::uint32_t flags, std::uint32_t method) {
  constexpr std::uint32_t kEncrypted = 1, kStored = 0, kDeflated = 8, kZip64 = 0xffffffff;
  if ((flags & kEncrypted) != 0) refuse_archive(quoted_text(entry.name) + " is encrypted");
  if (method != kStored && method != kDeflated)
    refuse_archive(quoted_text(entry.name) + " is neither stored nor deflated");
  if (entry.packed_size == kZip64 || entry.size == kZip64)
    refuse_archive(quoted_text(entry.name) + " is larger than 4 GiB");
  if (method == kStored && entry.packed_size != entry.size)
    refuse_archive(quoted_text(entry.name) + " is stored in another size than its own");
}

/// Takes a line off the directory.
ZipEntry read_directory_line(std::string_view archive, std::string_view& directory) {
  const std::string_view line = part(directory, 0, kDirectoryLineBytes);
  if (!line.starts_with(kDirectoryMark)) refuse_archive("its directory is damaged");
  const std::size_t name_size = little_endian_at(line, 28, 2);
  const std::size_t rest_size = little_endian_at(line, 30, 2) + little_endian_at(line, 32, 2);
  ZipEntry entry{.name = std::string(part(directory, kDirectoryLineBytes, name_size)),
                 .deflated = little_endian_at(line, 10, 2) != 0,
                 .crc = little_endian_at(line, 16, 4),
                 .packed_size = little_endian_at(line, 20, 4),
                 .size = little_endian_at(line, 24, 4),
                 .packed = {}};
  directory.remove_prefix(part(directory, 0, kDirectoryLineBytes + name_size + rest_size).size());
  check_entry(entry, little_endian_at(line, 8, 2), little_endian_at(line, 10, 2));
  entry.packed = find_packed(archive, little_endian_at(line, 42, 4), entry);
  return entry;
}

/// Inflates a stream into its room, to the end.
/// @param beyond  room for a byte too many  @returns zlib's result; Z_DATA_ERROR if there is such a byte
int inflate_to_end(z_stream& stream, Bytef* beyond) {
  int result = inflate(&stream, Z_FINISH);
  if (result == Z_BUF_ERROR && stream.avail_out == 0) {  // the end of the stream may still be unread
    stream.next_out = beyond;
    stream.avail_out = 1;
    result = inflate(&stream, Z_FINISH);
    if (stream.avail_out == 0) result = Z_DATA_ERROR;
  }
  return result;
}

/// Inflates a raw stream into room of the size that it must have. False if the stream has another size or is
/// damaged.
bool inflate_to(std::string_view packed, std::string& to) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  Bytef beyond = 0;  // zlib takes no null pointer
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = to.empty() ? &beyond : reinterpret_cast<Bytef*>(to.data());
  stream.avail_out = static_cast<uInt>(to.size());
  const int result = inflate_to_end(stream, &beyond);
  const bool whole = result == Z_STREAM_END && stream.avail_in == 0 && stream.total_out == to.size();
  inflateEnd(&stream);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  return whole;
}

}  // namespace

std::vector<ZipEntry> read_zip_directory(std::string_view archive, std::size_t most_bytes) {
  const std::string_view end = find_end(archive);
  check_end_record(end);
  std::string_view directory = part(archive, little_endian_at(end, 16, 4), little_endian_at(end, 12, 4));
  std::vector<ZipEntry> entries;
  std::size_t bytes = 0;
  for (std::size_t left = little_endian_at(end, 10, 2); left > 0; --left) {
    entries.push_back(read_directory_line(archive, directory));
    bytes += entries.back().size;
    if (bytes > most_bytes)
      refuse_archive("its arrays take more than " + std::to_string(most_bytes) + " bytes");
  }
  if (!directory.empty()) refuse_archive("its directory is damaged");
  return entries;
}

std::string unpack(const ZipEntry& entry) {
  std::string bytes;
  if (entry.deflated) {
    // Deflate makes at most 1032 bytes of one.
    constexpr std::size_t kMostRatio = 1032;
    if (entry.size > (entry.packed_size + 1) * kMostRatio)
      refuse_archive(quoted_text(entry.name) + " is damaged: so few bytes do not hold so many");
    bytes.resize(entry.size);
    if (!inflate_to(entry.packed, bytes)) refuse_archive(quoted_text(entry.name) + " is damaged");
  } else {
    bytes = entry.packed;
  }
  const uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (crc != entry.crc) refuse_archive("the checksum of " + quoted_text(entry.name) + " is wrong");
  return bytes;
}

}  // namespace jobs
