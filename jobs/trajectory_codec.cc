#include "jobs/trajectory_codec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "jobs/byte_codec.h"

namespace jobs {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kLargestHeader = 1U << 20U;
constexpr std::uint64_t kMostSamples = 10'000'000;

enum class Encoding : std::uint8_t { kUniformTime, kDouble, kSingle };
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
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

std::optional<UniformTime> find_uniform_time(const std::vector<double>& column) {
  if (column.size() < 3 || !(column[1] > 0.0)) return std::nullopt;
  for (const double rate : {std::round(1.0 / column[1]), 1.0 / column[1]}) {
    const UniformTime time{rate, column.back()};
    if (rate > 0.0 && same_bits(times_of(time, column.size()), column)) return time;
  }
  return std::nullopt;
}

std::size_t count_samples(const engine::Trajectory& trajectory) { return trajectory.columns.empty() ? 0 : trajectory.columns.front().size(); }

void check_is_table(const engine::Trajectory& trajectory) {
  const std::size_t samples = count_samples(trajectory);
  const bool is_table = trajectory.columns.size() == trajectory.channels.size() &&
                        std::ranges::all_of(trajectory.columns, [&](const auto& column) { return column.size() == samples; });
  if (!is_table) throw std::invalid_argument("a trajectory must have one column for each channel, all of one length");
}

template <typename T>
std::string_view bytes_of(const std::vector<T>& items) {
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)};
}

struct Block {
  Encoding encoding;
  std::string bytes;
};

Block encode_column(const engine::QuantityInfo& channel, const std::vector<double>& column) {
  if (channel.single_precision) {
    const std::vector<float> singles(column.begin(), column.end());
    return {Encoding::kSingle, compress(shuffle(bytes_of(singles), sizeof(float)))};
  }
  if (const auto time = channel.key == "t_s" ? find_uniform_time(column) : std::nullopt) {
    ByteWriter writer;
    writer.number(time->rate);
    writer.number(time->last);
    return {Encoding::kUniformTime, compress(writer.bytes())};
  }
  return {Encoding::kDouble, compress(shuffle(bytes_of(column), sizeof(double)))};
}

/// What the header says of a channel.
struct Entry {
  engine::QuantityInfo info;
  Encoding encoding = Encoding::kDouble;
  std::span<const std::byte> block;
};

struct Contents {
  std::size_t samples = 0;
  std::vector<Entry> entries;
};

Entry read_entry(ByteReader& header, ByteReader& blob) {
  Entry entry;
  entry.info.key = header.text();
  entry.info.help = header.text();
  const auto flags = header.number<std::uint8_t>();
  entry.info.integer = (flags & kInteger) != 0;
  entry.info.single_precision = (flags & kSinglePrecision) != 0;
  const auto encoding = header.number<std::uint8_t>();
  if (encoding > static_cast<std::uint8_t>(Encoding::kSingle)) throw DamagedTrajectory("the trajectory has a block of an unknown kind");
  entry.encoding = static_cast<Encoding>(encoding);
  entry.block = blob.take(header.number<std::uint32_t>());
  return entry;
}

Contents read_contents(std::span<const std::byte> bytes) {
  ByteReader blob(bytes);
  if (blob.number<std::uint8_t>() != kVersion) throw DamagedTrajectory("the trajectory is of an unknown version");
  const std::string header_bytes = decompress(blob.take(blob.number<std::uint32_t>()), kLargestHeader);
  ByteReader header(std::as_bytes(std::span(header_bytes)));
  const auto samples = header.number<std::uint64_t>();
  if (samples > kMostSamples) throw DamagedTrajectory("the trajectory is too long");
  Contents contents{.samples = static_cast<std::size_t>(samples), .entries = {}};
  const auto channels = header.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < channels; ++i) contents.entries.push_back(read_entry(header, blob));
  if (!blob.at_end() || !header.at_end()) throw DamagedTrajectory("the trajectory has bytes after its end");
  return contents;
}

template <typename T>
std::vector<double> decode_items(std::span<const std::byte> block, std::size_t samples) {
  const std::string bytes = unshuffle(decompress(block, samples * sizeof(T)), sizeof(T));
  if (bytes.size() != samples * sizeof(T)) throw DamagedTrajectory("a column of the trajectory has a wrong length");
  std::vector<T> items(samples);
  if (samples > 0) std::memcpy(items.data(), bytes.data(), bytes.size());
  return {items.begin(), items.end()};
}

std::vector<double> decode_column(const Entry& entry, std::size_t samples) {
  switch (entry.encoding) {
    case Encoding::kSingle: return decode_items<float>(entry.block, samples);
    case Encoding::kDouble: return decode_items<double>(entry.block, samples);
    case Encoding::kUniformTime: break;
  }
  const std::string bytes = decompress(entry.block, sizeof(UniformTime));
  ByteReader reader(std::as_bytes(std::span(bytes)));
  const auto rate = reader.number<double>();
  const auto last = reader.number<double>();
  return times_of({rate, last}, samples);
}

}  // namespace

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
  const std::size_t samples = count_samples(trajectory);
  ByteWriter header;
  header.number(std::uint64_t{samples});
  header.number(static_cast<std::uint32_t>(trajectory.channels.size()));
  std::string blocks;
  for (std::size_t i = 0; i < trajectory.channels.size(); ++i) {
    const engine::QuantityInfo& channel = trajectory.channels[i];
    const Block block = encode_column(channel, trajectory.columns[i]);
    header.text(channel.key);
    header.text(channel.help);
    header.number(static_cast<std::uint8_t>((channel.integer ? kInteger : 0) | (channel.single_precision ? kSinglePrecision : 0)));
    header.number(static_cast<std::uint8_t>(block.encoding));
    header.number(static_cast<std::uint32_t>(block.bytes.size()));
    blocks += block.bytes;
  }
  const std::string packed_header = compress(header.bytes());
  ByteWriter blob;
  blob.number(kVersion);
  blob.number(static_cast<std::uint32_t>(packed_header.size()));
  return blob.bytes() + packed_header + blocks;
}

engine::Trajectory decode_trajectory(std::span<const std::byte> blob, std::span<const std::string> keys) {
  const Contents contents = read_contents(blob);
  engine::Trajectory trajectory;
  const auto add = [&](const Entry& entry) {
    trajectory.channels.push_back(entry.info);
    trajectory.columns.push_back(decode_column(entry, contents.samples));
  };
  if (keys.empty()) std::ranges::for_each(contents.entries, add);
  for (const std::string& key : keys) {
    const auto found = std::ranges::find(contents.entries, key, [](const Entry& entry) { return entry.info.key; });
    if (found != contents.entries.end()) add(*found);
  }
  return trajectory;
}

std::vector<engine::QuantityInfo> decode_channels(std::span<const std::byte> blob) {
  std::vector<engine::QuantityInfo> channels;
  for (Entry& entry : read_contents(blob).entries) channels.push_back(std::move(entry.info));
  return channels;
}

}  // namespace jobs
