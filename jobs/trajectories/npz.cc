// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/npz.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include <zlib.h>

namespace jobs {
namespace {

static_assert(std::endian::native == std::endian::little, "doubles are written as they stand in memory");

void append_u16(std::string& bytes, std::uint32_t value) {
  bytes += static_cast<char>(value & 0xffU);
  bytes += static_cast<char>((value >> 8U) & 0xffU);
}

void append_u32(std::string& bytes, std::uint32_t value) {
  append_u16(bytes, value & 0xffffU);
  append_u16(bytes, value >> 16U);
}

/// The head of a .npy file of version 1.0: its size, with the 10 bytes before it, is a multiple of 64.
std::string npy_head(std::size_t values) {
  std::string dictionary =
      "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(values) + ",), }";
  while ((10 + dictionary.size() + 1) % 64 != 0) dictionary += ' ';
  dictionary += '\n';
  std::string head = "\x93NUMPY";
  head += '\x01';
  head += '\0';
  append_u16(head, static_cast<std::uint32_t>(dictionary.size()));
  return head + dictionary;
}

/// One entry of the archive.
struct ArchivedFile {
  std::string name;
  std::uint32_t crc = 0;
  std::uint32_t size = 0;
  std::uint32_t offset = 0;  ///< of its local header
};

std::uint32_t crc_of(std::string_view head, std::string_view data) {
  uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(head.data()), head.size());
  // A null pointer, which an empty column may be, would start it afresh.
  if (!data.empty()) crc = crc32_z(crc, reinterpret_cast<const Bytef*>(data.data()), data.size());
  return static_cast<std::uint32_t>(crc);
}

/// Fields that a local header and a line of the directory have in common.
void append_description(std::string& bytes, const ArchivedFile& entry) {
  constexpr std::uint32_t kVersion = 20;
  constexpr std::uint32_t kMidnight = 0;
  constexpr std::uint32_t kFirstDay = (1U << 5U) | 1U;  // 1980-01-01: no clock in the bytes
  append_u16(bytes, kVersion);
  append_u16(bytes, 0);  // flags
  append_u16(bytes, 0);  // stored
  append_u16(bytes, kMidnight);
  append_u16(bytes, kFirstDay);
  append_u32(bytes, entry.crc);
  append_u32(bytes, entry.size);
  append_u32(bytes, entry.size);
  append_u16(bytes, static_cast<std::uint32_t>(entry.name.size()));
  append_u16(bytes, 0);  // no extra fields
}

void append_directory_line(std::string& bytes, const ArchivedFile& entry) {
  bytes += "PK\x01\x02";
  append_u16(bytes, 20);  // made by version 2.0, on MS-DOS: no permissions
  append_description(bytes, entry);
  append_u16(bytes, 0);  // no comment
  append_u16(bytes, 0);  // first disk
  append_u16(bytes, 0);  // internal attributes
  append_u32(bytes, 0);  // external attributes
  append_u32(bytes, entry.offset);
  bytes += entry.name;
}

void append_end(std::string& bytes, std::size_t entries, std::size_t directory_offset) {
  const std::size_t directory_size = bytes.size() - directory_offset;
  bytes += "PK\x05\x06";
  append_u16(bytes, 0);
  append_u16(bytes, 0);
  append_u16(bytes, static_cast<std::uint32_t>(entries));
  append_u16(bytes, static_cast<std::uint32_t>(entries));
  append_u32(bytes, static_cast<std::uint32_t>(directory_size));
  append_u32(bytes, static_cast<std::uint32_t>(directory_offset));
  append_u16(bytes, 0);  // no comment
}

void check_size(const engine::Trajectory& trajectory) {
  // The rest is for names
  constexpr std::size_t kLargest = std::numeric_limits<std::uint32_t>::max() - (std::size_t{1} << 20U);
  std::size_t values = 0;
  for (const auto& column : trajectory.columns) values += column.size();
  if (values > kLargest / sizeof(double))
    throw std::length_error("the trajectory is too large for an .npz file; take fewer channels or samples");
}

}  // namespace

std::string to_npz(const engine::Trajectory& trajectory) {
  check_size(trajectory);
  std::string bytes;
  std::vector<ArchivedFile> entries;
  for (std::size_t c = 0; c < trajectory.channels.size(); ++c) {
    const std::span column(trajectory.columns[c]);
    const std::string head = npy_head(column.size());
    const std::string_view data(reinterpret_cast<const char*>(column.data()), column.size_bytes());
    entries.push_back({.name = trajectory.channels[c].key + ".npy",
                       .crc = crc_of(head, data),
                       .size = static_cast<std::uint32_t>(head.size() + data.size()),
                       .offset = static_cast<std::uint32_t>(bytes.size())});
    bytes += "PK\x03\x04";
    append_description(bytes, entries.back());
    bytes += entries.back().name;
    bytes += head;
    bytes += data;
  }
  const std::size_t directory_offset = bytes.size();
  for (const ArchivedFile& entry : entries) append_directory_line(bytes, entry);
  append_end(bytes, entries.size(), directory_offset);
  return bytes;
}

}  // namespace jobs
