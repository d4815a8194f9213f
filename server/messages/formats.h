// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace server {

enum class TableFormat { kJson, kCsv, kNdjson, kHdf5, kMat, kNpz };

/// Kind of data that is written: a table of rows, channels over time, or those of all jobs of a sweep.
enum class DataShape { kRows, kColumns, kTrajectories };

struct FormatInfo {
  TableFormat format;
  std::string_view word;  ///< of ?format= and --format, and the end of a file's name
  std::string_view media_type;
  std::array<bool, 3> shapes;  ///< by DataShape

  [[nodiscard]] constexpr bool holds(DataShape shape) const {
    return shapes[static_cast<std::size_t>(shape)];
  }
};

/// All formats, the default of a request without format first. By TableFormat.
inline constexpr std::array<FormatInfo, 6> kFormats{
    {{TableFormat::kJson, "json", "application/json", {true, true, false}},
     {TableFormat::kCsv, "csv", "text/csv", {true, true, false}},
     {TableFormat::kNdjson, "ndjson", "application/x-ndjson", {true, false, false}},
     {TableFormat::kHdf5, "h5", "application/x-hdf5", {false, false, true}},
     {TableFormat::kMat, "mat", "application/x-matlab-data", {false, false, true}},
     {TableFormat::kNpz, "npz", "application/x-npz", {false, true, true}}}};

[[nodiscard]] constexpr const FormatInfo& info_of(TableFormat format) {
  return kFormats[static_cast<std::size_t>(format)];
}

/// The formats that hold data of that shape, in the order of kFormats.
[[nodiscard]] inline std::vector<FormatInfo> formats_of(DataShape shape) {
  std::vector<FormatInfo> formats;
  for (const FormatInfo& info : kFormats)
    if (info.holds(shape)) formats.push_back(info);
  return formats;
}

/// Their words.
[[nodiscard]] inline std::vector<std::string_view> format_words(DataShape shape) {
  std::vector<std::string_view> words;
  for (const FormatInfo& info : formats_of(shape)) words.push_back(info.word);
  return words;
}

[[nodiscard]] constexpr std::optional<TableFormat> find_format(std::string_view word) {
  const auto* const found = std::ranges::find(kFormats, word, &FormatInfo::word);
  return found == kFormats.end() ? std::nullopt : std::optional(found->format);
}

}  // namespace server
