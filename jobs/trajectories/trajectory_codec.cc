// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/trajectory_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "jobs/trajectories/byte_codec.h"
#include "jobs/trajectories/single_column.h"

namespace jobs {
namespace {

constexpr std::uint8_t kOldestVersion = 1;  // has no packed singles and no copies
constexpr std::uint8_t kVersion = 2;
constexpr std::size_t kLargestHeader = 1U << 24U;  // the largest linkages have some megabytes of names
constexpr std::uint64_t kMostSamples = 10'000'000;

// kSingle is of the oldest version: floats, shuffled like doubles.
enum class Encoding : std::uint8_t { kUniformTime, kDouble, kSingle, kPackedSingle, kCopy };
enum Flags : std::uint8_t { kInteger = 1, kSinglePrecision = 2 };

/// t_k = k / rate but for the last one, which may fall between two.
struct UniformTime {
  double rate = 0.0;
  double last = 0.0;
};

std::vector<double> times_of(const UniformTime& time, std::size_t samples) {
  std::vector<double> column(samples);
  for (std::size_t k = 0; k + 1 < samples; ++k) column[k] = static_cast<double>(k) / time.rate;
  if (samples > 0) column.back() = time.last;
  return column;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

std::optional<UniformTime> find_uniform_time(const std::vector<double>& column) {
  if (column.size() < 3 || !(column[1] > 0.0)) return std::nullopt;
  for (const double rate : {std::round(1.0 / column[1]), 1.0 / column[1]}) {
    const UniformTime time{rate, column.back()};
    if (rate > 0.0 && same_bits(times_of(time, column.size()), column)) return time;
  }
  return std::nullopt;
}

std::size_t count_rows(const engine::Trajectory& trajectory) {
  return trajectory.columns.empty() ? 0 : trajectory.columns.front().size();
}

template <typename T>
std::string_view bytes_of(const std::vector<T>& items) {
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)};
}

/// A column as it is stored, before it is made a frame.
struct EncodedColumn {
  Encoding encoding = Encoding::kDouble;
  std::string bytes;
  std::size_t copied = 0;  ///< kCopy: the channel that has the same column
};

EncodedColumn encode_column(const engine::QuantityInfo& channel, const std::vector<double>& column,
                            SinglePacker& packer) {
  if (channel.single_precision) return {Encoding::kPackedSingle, std::string(packer.pack(column))};
  if (const auto time = channel.key == "t_s" ? find_uniform_time(column) : std::nullopt) {
    ByteWriter writer;
    writer.number(time->rate);
    writer.number(time->last);
    return {Encoding::kUniformTime, writer.bytes()};
  }
  return {Encoding::kDouble, shuffle(bytes_of(column), sizeof(double))};
}

/// The first channel before the i-th that has the same numbers and is kept as precisely; i if there is none.
std::size_t find_original(const engine::Trajectory& trajectory, std::size_t i) {
  std::size_t k = 0;
  while (k < i && (trajectory.channels[k].single_precision != trajectory.channels[i].single_precision ||
                   !same_bits(trajectory.columns[k], trajectory.columns[i]))) {
    ++k;
  }
  return k;
}

/// The i-th column. A column that has been met already (the pose of the slider repeats its position, say)
/// becomes a copy of that one; numbers that are the same when rounded are seen by their bytes.
/// @param before  the columns before it
EncodedColumn encode_new_column(const engine::Trajectory& trajectory, std::size_t i,
                                std::span<const EncodedColumn> before, SinglePacker& packer) {
  const auto copy_of = [](std::size_t original) { return EncodedColumn{Encoding::kCopy, {}, original}; };
  if (const std::size_t original = find_original(trajectory, i); original < i) return copy_of(original);
  EncodedColumn block = encode_column(trajectory.channels[i], trajectory.columns[i], packer);
  const auto is_same = [&](const EncodedColumn& other) {
    return other.encoding == block.encoding && other.bytes == block.bytes;
  };
  const auto same = std::ranges::find_if(before, is_same);
  if (same != before.end()) return copy_of(static_cast<std::size_t>(same - before.begin()));
  return block;
}

std::vector<EncodedColumn> encode_columns(const engine::Trajectory& trajectory) {
  SinglePacker packer;
  std::vector<EncodedColumn> blocks;
  blocks.reserve(trajectory.columns.size());
  for (std::size_t i = 0; i < trajectory.columns.size(); ++i)
    blocks.push_back(encode_new_column(trajectory, i, blocks, packer));
  return blocks;
}

/// Room for the frames of columns.
std::size_t calc_frame_room(const std::vector<EncodedColumn>& blocks) {
  const auto add_room = [](std::size_t sum, const EncodedColumn& block) {
    return sum + block.bytes.size() + 32;
  };
  return std::accumulate(blocks.begin(), blocks.end(), std::size_t{0}, add_room);
}

void write_channel(ByteWriter& header, const engine::QuantityInfo& channel, Encoding encoding) {
  header.text(channel.key);
  header.text(channel.help);
  header.number(static_cast<std::uint8_t>((channel.integer ? kInteger : 0) |
                                          (channel.single_precision ? kSinglePrecision : 0)));
  header.number(static_cast<std::uint8_t>(encoding));
}

/// Appends the frame of a column; of a copy there is none.
/// @returns its size; of a copy the number of the channel that it copies
std::size_t append_block(const EncodedColumn& block, Compressor& compressor, std::string& frames) {
  if (block.encoding == Encoding::kCopy) return block.copied;
  const Effort effort = block.encoding == Encoding::kPackedSingle ? Effort::kLittle : Effort::kFull;
  return compressor.append_frame(block.bytes, effort, frames);
}

std::string join_blob(const ByteWriter& header, const std::string& frames, Compressor& compressor) {
  std::string packed_header;
  compressor.append_frame(header.bytes(), Effort::kFull, packed_header);
  ByteWriter prefix;
  prefix.number(kVersion);
  prefix.number(static_cast<std::uint32_t>(packed_header.size()));
  std::string bytes = prefix.bytes();
  bytes.reserve(bytes.size() + packed_header.size() + frames.size());
  return bytes.append(packed_header).append(frames);
}

/// Place of a zstd frame in a blob.
struct Frame {
  std::size_t offset = 0, size = 0;
};

/// Channel in the header.
struct StoredChannel {
  engine::QuantityInfo info;
  Encoding encoding = Encoding::kDouble;
  Frame frame;  ///< of a copy, that of its original
};

struct Contents {
  std::size_t samples = 0;
  std::vector<StoredChannel> entries;
};

/// Hands out the bytes of a blob after its header, frame by frame.
class FrameSpace {
 public:
  FrameSpace(std::size_t begin, std::size_t end) : next_(begin), end_(end) {}
  Frame take(std::size_t size) {
    if (size > end_ - next_) throw DamagedTrajectory("the trajectory ends too early");
    return {.offset = std::exchange(next_, next_ + size), .size = size};
  }
  [[nodiscard]] bool at_end() const { return next_ == end_; }

 private:
  std::size_t next_, end_;
};

/// Finds a channel's frame.
/// @param number  size of the frame; of a copy the number of its original  @param before  read_entry()'s
void place_entry(StoredChannel& entry, std::uint32_t number, FrameSpace& frames,
                 std::span<const StoredChannel> before) {
  if (entry.encoding != Encoding::kCopy) {
    entry.frame = frames.take(number);
  } else if (number < before.size()) {
    entry.encoding = before[number].encoding;
    entry.frame = before[number].frame;
  } else {
    throw DamagedTrajectory("the trajectory has a copy of a channel that it does not have");
  }
}

/// @param before  the channels that a copy may be of
StoredChannel read_entry(ByteReader& header, FrameSpace& frames, std::span<const StoredChannel> before) {
  StoredChannel entry;
  entry.info.key = header.text();
  entry.info.help = header.text();
  const auto flags = header.number<std::uint8_t>();
  entry.info.integer = (flags & kInteger) != 0;
  entry.info.single_precision = (flags & kSinglePrecision) != 0;
  const auto encoding = header.number<std::uint8_t>();
  if (encoding > static_cast<std::uint8_t>(Encoding::kCopy))
    throw DamagedTrajectory("the trajectory has a block of an unknown kind");
  entry.encoding = static_cast<Encoding>(encoding);
  place_entry(entry, header.number<std::uint32_t>(), frames, before);
  return entry;
}

/// Version and size of the header, before it.
constexpr std::size_t kPrefix = 1 + sizeof(std::uint32_t);

/// @param prefix  first bytes of the blob @returns size of the packed header
std::size_t read_prefix(std::span<const std::byte> prefix) {
  ByteReader reader(prefix);
  const auto version = reader.number<std::uint8_t>();
  if (version < kOldestVersion || version > kVersion)
    throw DamagedTrajectory("the trajectory is of an unknown version");
  return reader.number<std::uint32_t>();
}

/// @param packed_header  after the prefix of a blob of that size
Contents read_header(std::span<const std::byte> packed_header, std::size_t blob_size) {
  FrameSpace frames(kPrefix + packed_header.size(), blob_size);
  const std::string header_bytes = decompress(packed_header, kLargestHeader);
  ByteReader header(std::as_bytes(std::span(header_bytes)));
  const auto samples = header.number<std::uint64_t>();
  if (samples > kMostSamples) throw DamagedTrajectory("the trajectory is too long");
  Contents contents{.samples = static_cast<std::size_t>(samples), .entries = {}};
  const auto channels = header.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < channels; ++i)
    contents.entries.push_back(read_entry(header, frames, contents.entries));
  if (!frames.at_end() || !header.at_end()) throw DamagedTrajectory("the trajectory has bytes after its end");
  return contents;
}

Contents read_contents(std::span<const std::byte> blob) {
  ByteReader reader(blob);
  const std::size_t size = read_prefix(reader.take(kPrefix));
  return read_header(reader.take(size), blob.size());
}

template <typename T>
std::vector<double> decode_items(std::span<const std::byte> block, std::size_t samples) {
  const std::string bytes = unshuffle(decompress(block, samples * sizeof(T)), sizeof(T));
  if (bytes.size() != samples * sizeof(T))
    throw DamagedTrajectory("a column of the trajectory has a wrong length");
  std::vector<T> items(samples);
  if (samples > 0) std::memcpy(items.data(), bytes.data(), bytes.size());
  return {items.begin(), items.end()};
}

UniformTime read_uniform_time(std::string_view bytes) {
  ByteReader reader(std::as_bytes(std::span(bytes)));
  const auto rate = reader.number<double>();
  const auto last = reader.number<double>();
  return {.rate = rate, .last = last};
}

std::vector<double> decode_column(const StoredChannel& entry, std::span<const std::byte> blob,
                                  std::size_t samples) {
  const std::span<const std::byte> block = blob.subspan(entry.frame.offset, entry.frame.size);
  switch (entry.encoding) {
    case Encoding::kSingle: return decode_items<float>(block, samples);
    case Encoding::kDouble: return decode_items<double>(block, samples);
    case Encoding::kPackedSingle:
      return unpack_singles(decompress(block, largest_packed_size(samples)), samples);
    case Encoding::kUniformTime:
    case Encoding::kCopy: break;  // an entry has the encoding of what it copies
  }
  return times_of(read_uniform_time(decompress(block, sizeof(UniformTime))), samples);
}

class UniformTimeCursor final : public ColumnCursor {
 public:
  UniformTimeCursor(const UniformTime& time, std::size_t samples) : time_(time), samples_(samples) {}
  void append_next(std::size_t count, std::vector<double>& to) override {
    for (; count > 0 && next_ < samples_; --count, ++next_)
      to.push_back(next_ + 1 == samples_ ? time_.last : static_cast<double>(next_) / time_.rate);
  }

 private:
  UniformTime time_;
  std::size_t samples_;
  std::size_t next_ = 0;
};

/// Of shuffled items.
template <typename T>
class ItemCursor final : public ColumnCursor {
 public:
  ItemCursor(std::string_view shuffled, std::size_t samples) : shuffled_(shuffled), samples_(samples) {}
  void append_next(std::size_t count, std::vector<double>& to) override {
    for (; count > 0 && next_ < samples_; --count, ++next_) {
      std::array<char, sizeof(T)> bytes;
      for (std::size_t b = 0; b < bytes.size(); ++b) bytes[b] = shuffled_[b * samples_ + next_];
      to.push_back(static_cast<double>(std::bit_cast<T>(bytes)));
    }
  }

 private:
  std::string_view shuffled_;
  std::size_t samples_;
  std::size_t next_ = 0;
};

class SingleCursor final : public ColumnCursor {
 public:
  SingleCursor(std::string_view packed, std::size_t samples) : unpacker_(packed, samples) {}
  void append_next(std::size_t count, std::vector<double>& to) override { unpacker_.append_next(count, to); }

 private:
  SingleUnpacker unpacker_;
};

/// Largest size of a column before it is made a frame.
std::size_t largest_size(Encoding encoding, std::size_t samples) {
  switch (encoding) {
    case Encoding::kSingle: return samples * sizeof(float);
    case Encoding::kDouble: return samples * sizeof(double);
    case Encoding::kPackedSingle: return largest_packed_size(samples);
    case Encoding::kUniformTime:
    case Encoding::kCopy: break;
  }
  return sizeof(UniformTime);
}

/// Frame of one column or of several that are the same, and the column's place among all.
struct LoadedFrame {
  std::size_t size = 0, place = 0, decompressed = 0;
};

/// Takes columns out of their frames. @param frames  by their offset  @param size  of all columns together
std::shared_ptr<LargeBuffer> decompress_frames(const StoredBytes& blob,
                                               const std::map<std::size_t, LoadedFrame>& frames,
                                               std::size_t size) {
  std::size_t largest = 0;
  for (const auto& [offset, frame] : frames) largest = std::max(largest, frame.size);
  auto columns = std::make_shared<LargeBuffer>(size);
  LargeBuffer packed(largest);
  for (const auto& [offset, frame] : frames) {
    const auto bytes = packed.bytes().first(frame.size);
    blob.read_to(offset, bytes);
    decompress_to(std::as_bytes(bytes), columns->bytes().subspan(frame.place, frame.decompressed));
  }
  return columns;
}

}  // namespace

void check_is_table(const engine::Trajectory& trajectory) {
  const std::size_t samples = count_rows(trajectory);
  const bool is_table =
      trajectory.columns.size() == trajectory.channels.size() &&
      std::ranges::all_of(trajectory.columns, [&](const auto& column) { return column.size() == samples; });
  if (!is_table)
    throw std::invalid_argument("a trajectory must have one column for each channel, all of one length");
}

engine::Trajectory rounded_to_stored(engine::Trajectory trajectory) {
  check_is_table(trajectory);
  for (std::size_t i = 0; i < trajectory.columns.size(); ++i) {
    if (!trajectory.channels[i].single_precision) continue;
    for (double& x : trajectory.columns[i]) x = static_cast<double>(static_cast<float>(x));
  }
  return trajectory;
}

std::string encode_trajectory(const engine::Trajectory& trajectory) {
  check_is_table(trajectory);
  thread_local Compressor compressor;  // takes longer to make than a short trajectory to compress
  ByteWriter header;
  header.number(std::uint64_t{count_rows(trajectory)});
  header.number(static_cast<std::uint32_t>(trajectory.channels.size()));
  const std::vector<EncodedColumn> blocks = encode_columns(trajectory);
  std::string frames;
  frames.reserve(calc_frame_room(blocks));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    write_channel(header, trajectory.channels[i], blocks[i].encoding);
    header.number(static_cast<std::uint32_t>(append_block(blocks[i], compressor, frames)));
  }
  return join_blob(header, frames, compressor);
}

engine::Trajectory decode_trajectory(std::span<const std::byte> blob, std::span<const std::string> keys) {
  const Contents contents = read_contents(blob);
  engine::Trajectory trajectory;
  const auto add = [&](const StoredChannel& entry) {
    trajectory.channels.push_back(entry.info);
    trajectory.columns.push_back(decode_column(entry, blob, contents.samples));
  };
  if (keys.empty()) std::ranges::for_each(contents.entries, add);
  for (const std::string& key : keys) {
    const auto found =
        std::ranges::find(contents.entries, key, [](const StoredChannel& entry) { return entry.info.key; });
    if (found != contents.entries.end()) add(*found);
  }
  return trajectory;
}

std::vector<engine::QuantityInfo> decode_channels(std::span<const std::byte> blob) {
  std::vector<engine::QuantityInfo> channels;
  for (StoredChannel& entry : read_contents(blob).entries) channels.push_back(std::move(entry.info));
  return channels;
}

PackedTrajectory::PackedTrajectory(const StoredBytes& blob) {
  if (blob.size < kPrefix) throw DamagedTrajectory("the trajectory ends too early");
  const std::string prefix = blob.read(0, kPrefix);
  const std::size_t size = read_prefix(std::as_bytes(std::span(prefix)));
  if (size > blob.size - kPrefix) throw DamagedTrajectory("the trajectory ends too early");
  header_ = blob.read(kPrefix, size);
  Contents contents = read_header(std::as_bytes(std::span(header_)), blob.size);
  samples_ = contents.samples;
  for (StoredChannel& entry : contents.entries)
    channels_.push_back({.info = std::move(entry.info),
                         .encoding = static_cast<std::uint8_t>(entry.encoding),
                         .offset = entry.frame.offset,
                         .size = entry.frame.size});
}

std::vector<engine::QuantityInfo> PackedTrajectory::channels() const {
  std::vector<engine::QuantityInfo> channels;
  for (const Channel& channel : channels_) channels.push_back(channel.info);
  return channels;
}

void PackedTrajectory::select(std::span<const std::string> keys) {
  if (keys.empty()) return;
  std::vector<Channel> selected;
  for (const std::string& key : keys) {
    const auto found = std::ranges::find(channels_, key, [](const Channel& each) { return each.info.key; });
    if (found != channels_.end()) selected.push_back(*found);
  }
  channels_ = std::move(selected);
}

std::string PackedTrajectory::checksums(const StoredBytes& blob) const {
  constexpr std::size_t kChecksum = 4;  // at the end of a frame
  std::string sums = header_;
  for (const Channel& channel : channels_) {
    const std::size_t size = std::min(channel.size, kChecksum);
    sums += blob.read(channel.offset + channel.size - size, size);
  }
  return sums;
}

std::size_t PackedTrajectory::find_column_size(const StoredBytes& blob, const Channel& channel) const {
  const std::string head = blob.read(channel.offset, std::min(channel.size, kLargestFrameHead));
  const auto encoding = static_cast<Encoding>(channel.encoding);
  const std::size_t most = largest_size(encoding, samples_);
  const std::size_t size = decompressed_size(std::as_bytes(std::span(head)), most);
  if (encoding != Encoding::kPackedSingle && size != most)
    throw DamagedTrajectory("a column of the trajectory has a wrong length");
  return size;
}

void PackedTrajectory::load(const StoredBytes& blob) {
  std::map<std::size_t, LoadedFrame> frames;  // by their offset
  std::size_t total = 0;
  for (const Channel& channel : channels_) {
    const auto [frame, is_new] =
        frames.try_emplace(channel.offset, LoadedFrame{.size = channel.size, .place = total});
    if (!is_new) continue;
    frame->second.decompressed = find_column_size(blob, channel);
    total += frame->second.decompressed;
  }
  const auto columns = decompress_frames(blob, frames, total);
  for (Channel& channel : channels_) {
    const LoadedFrame& frame = frames.at(channel.offset);
    const auto column = columns->bytes().subspan(frame.place, frame.decompressed);
    channel.column = {column.data(), column.size()};
  }
  columns_ = columns;
}

std::unique_ptr<ColumnCursor> PackedTrajectory::read_column(std::size_t channel) const {
  const std::string_view column = channels_[channel].column;
  switch (static_cast<Encoding>(channels_[channel].encoding)) {
    case Encoding::kSingle: return std::make_unique<ItemCursor<float>>(column, samples_);
    case Encoding::kDouble: return std::make_unique<ItemCursor<double>>(column, samples_);
    case Encoding::kPackedSingle: return std::make_unique<SingleCursor>(column, samples_);
    case Encoding::kUniformTime:
    case Encoding::kCopy: break;
  }
  return std::make_unique<UniformTimeCursor>(read_uniform_time(column), samples_);
}

}  // namespace jobs
