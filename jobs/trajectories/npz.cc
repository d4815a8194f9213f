// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/npz.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <zlib.h>

#include "jobs/trajectories/trajectory_text.h"

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

/// One entry of the archive.
struct ArchivedFile {
  std::string name;
  std::uint32_t crc = 0;
  std::uint32_t size = 0;
  std::uint32_t offset = 0;  ///< of its local header
};

uLong add_to_crc(uLong crc, std::string_view data) {
  // A null pointer, which an empty column may be, would start it afresh.
  return data.empty() ? crc : crc32_z(crc, reinterpret_cast<const Bytef*>(data.data()), data.size());
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

void append_end(std::string& bytes, std::size_t entries, std::size_t directory_offset,
                std::size_t directory_size) {
  bytes += "PK\x05\x06";
  append_u16(bytes, 0);
  append_u16(bytes, 0);
  append_u16(bytes, static_cast<std::uint32_t>(entries));
  append_u16(bytes, static_cast<std::uint32_t>(entries));
  append_u32(bytes, static_cast<std::uint32_t>(directory_size));
  append_u32(bytes, static_cast<std::uint32_t>(directory_offset));
  append_u16(bytes, 0);  // no comment
}

void check_size(std::size_t values) {
  // The rest is for names
  constexpr std::size_t kLargest = std::numeric_limits<std::uint32_t>::max() - (std::size_t{1} << 20U);
  if (values > kLargest / sizeof(double))
    throw std::length_error("the trajectory is too large for an .npz file; take fewer channels or samples");
}

std::string_view bytes_of_doubles(std::span<const double> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// Makes an archive, entry by entry.
class NpzArchive {
 public:
  /// Appends what stands before the numbers of a channel.
  /// @param offset  bytes of the archive so far
  /// @param crc     of the head and the numbers
  void append_entry(std::string& bytes, std::size_t offset, const std::string& key, const std::string& head,
                    std::size_t data_bytes, uLong crc) {
    entries_.push_back({.name = key + ".npy",
                        .crc = static_cast<std::uint32_t>(crc),
                        .size = static_cast<std::uint32_t>(head.size() + data_bytes),
                        .offset = static_cast<std::uint32_t>(offset)});
    bytes += "PK\x03\x04";
    append_description(bytes, entries_.back());
    bytes += entries_.back().name;
    bytes += head;
  }

  void append_directory(std::string& bytes, std::size_t offset) const {
    const std::size_t start = bytes.size();
    for (const ArchivedFile& entry : entries_) append_directory_line(bytes, entry);
    append_end(bytes, entries_.size(), offset, bytes.size() - start);
  }

 private:
  std::vector<ArchivedFile> entries_;
};

/// Entries one after the other, each column read twice: its checksum stands before it.
class NpzText final : public TrajectoryText {
 public:
  explicit NpzText(TrajectoryView view) : view_(std::move(view)) {
    check_size(view_.samples() * view_.channels().size());
  }

  bool append_next(std::string& to) override {
    if (channel_ > view_.channels().size()) return false;
    const std::size_t before = to.size();
    if (channel_ == view_.channels().size()) {
      archive_.append_directory(to, offset_);
      ++channel_;
      return true;
    }
    append_values(to);
    offset_ += to.size() - before;
    return true;
  }

 private:
  /// Appends the next values of the channel, behind its head if they are the first.
  void append_values(std::string& to) {
    if (!column_) begin_column(to);
    const bool more = read(*column_);
    to += bytes_of_doubles(values_);
    if (more) return;
    column_.reset();
    ++channel_;
  }

  /// False after the last values.
  bool read(ColumnCursor& column) {
    constexpr std::size_t kValuesAChunk = 16 * 1024;
    values_.clear();
    column.append_next(kValuesAChunk, values_);
    return values_.size() == kValuesAChunk;
  }

  void begin_column(std::string& to) {
    const std::string head = npy_head("<f8", view_.samples());
    uLong crc = add_to_crc(0, head);
    const auto column = view_.read_column(channel_);
    for (bool more = true; more;) {
      more = read(*column);
      crc = add_to_crc(crc, bytes_of_doubles(values_));
    }
    archive_.append_entry(to, offset_, view_.channels()[channel_].key, head,
                          view_.samples() * sizeof(double), crc);
    column_ = view_.read_column(channel_);
  }

  TrajectoryView view_;
  NpzArchive archive_;
  std::size_t offset_ = 0;  ///< bytes so far
  std::size_t channel_ = 0;
  std::unique_ptr<ColumnCursor> column_;  ///< of the channel; null: it has not begun
  std::vector<double> values_;
};

}  // namespace

std::string npy_head(std::string_view type, std::size_t values) {
  std::string dictionary = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" +
                           std::to_string(values) + ",), }";
  while ((10 + dictionary.size() + 1) % 64 != 0) dictionary += ' ';
  dictionary += '\n';
  std::string head = "\x93NUMPY";
  head += '\x01';
  head += '\0';
  append_u16(head, static_cast<std::uint32_t>(dictionary.size()));
  return head + dictionary;
}

std::string to_npz(const engine::Trajectory& trajectory) {
  std::size_t values = 0;
  for (const auto& column : trajectory.columns) values += column.size();
  check_size(values);
  std::string bytes;
  NpzArchive archive;
  for (std::size_t c = 0; c < trajectory.channels.size(); ++c) {
    const std::string_view data = bytes_of_doubles(trajectory.columns[c]);
    const std::string head = npy_head("<f8", trajectory.columns[c].size());
    archive.append_entry(bytes, bytes.size(), trajectory.channels[c].key, head, data.size(),
                         add_to_crc(add_to_crc(0, head), data));
    bytes += data;
  }
  archive.append_directory(bytes, bytes.size());
  return bytes;
}

std::unique_ptr<TrajectoryText> npz_text(TrajectoryView view) {
  return std::make_unique<NpzText>(std::move(view));
}

}  // namespace jobs
