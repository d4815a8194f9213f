// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/table_json.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "jobs/results/resource_json.h"

namespace jobs {

void append_json_number(std::string& text, double value) {
  if (!std::isfinite(value)) {
    text += "null";
    return;
  }
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  text.append(digits, end);
}

namespace {

void append_json_cell(std::string& text, const nlohmann::json& cell) {
  if (cell.is_number_float()) {
    append_json_number(text, cell.get<double>());
  } else {
    text += text_of(cell);
  }
}

void append_json_optional(std::string& text, const std::optional<double>& value) {
  if (value) {
    append_json_number(text, *value);
  } else {
    text += "null";
  }
}

/// The keys are the columns of the CSV.
void append_replicates_to(std::string& text, const ReplicateStatistics& set) {
  text += "\"replicates_count\":" + std::to_string(set.count);
  for (const auto& [key, value] : {std::pair{"mean", set.mean}, {"spread", set.spread}, {"min", set.min},
                                   {"max", set.max}}) {
    text += std::string(",\"replicates_") + key + "\":";
    append_json_optional(text, value);
  }
}

/// `"key":` of every column, made once for all rows.
std::vector<std::string> quoted_keys(const std::vector<std::string>& columns) {
  std::vector<std::string> keys;
  for (const std::string& column : columns) keys.push_back(text_of(column) + ":");
  return keys;
}

/// @param keys  see quoted_keys()
void append_row_object(std::string& text, const std::vector<std::string>& keys, const ResultTable& table,
                       std::size_t row) {
  text += '{';
  for (std::size_t c = 0; c < keys.size(); ++c) {
    if (c > 0) text += ',';
    text += keys[c];
    append_json_cell(text, table.rows[row].at(c));
  }
  if (!table.replicates.empty()) {
    if (!keys.empty()) text += ',';
    append_replicates_to(text, table.replicates.at(row));
  }
  text += '}';
}

/// An object for each row. @param before_first, before  what stands before it
std::string joined_rows(const ResultTable& table, const char* before_first, const char* before) {
  const auto keys = quoted_keys(table.columns);
  std::string text;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (r == 1) text.reserve(table.rows.size() * (text.size() + text.size() / 8));
    text += r == 0 ? before_first : before;
    append_row_object(text, keys, table, r);
  }
  return text;
}

}  // namespace

std::string to_json_rows(const ResultTable& table) {
  return table.rows.empty() ? "[\n]\n" : joined_rows(table, "[\n", ",\n") + "\n]\n";
}

std::string to_json_lines(const ResultTable& table) {
  return table.rows.empty() ? "" : joined_rows(table, "", "\n") + "\n";
}

void append_json_channels(std::string& text, const std::vector<engine::QuantityInfo>& channels) {
  text += "{\"channels\":[";
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (c > 0) text += ',';
    text += text_of(channels[c].key);
  }
  text += "],\n\"columns\":{";
}

std::string to_json_columns(const engine::Trajectory& trajectory) {
  std::string text;
  append_json_channels(text, trajectory.channels);
  for (std::size_t c = 0; c < trajectory.channels.size(); ++c) {
    text += c == 0 ? "\n" : ",\n";
    text += text_of(trajectory.channels[c].key);
    text += ":[";
    for (std::size_t i = 0; i < trajectory.columns[c].size(); ++i) {
      if (i > 0) text += ',';
      append_json_number(text, trajectory.columns[c][i]);
    }
    text += ']';
  }
  text += "\n}}\n";
  return text;
}

}  // namespace jobs
