// SPDX-License-Identifier: Apache-2.0
#include "server/routes/tables.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/analysis/quantities.h"
#include "jobs/results/csv.h"
#include "server/messages/accept.h"
#include "server/messages/json_text.h"

namespace server {

namespace {

struct FormatInfo {
  TableFormat format;
  std::string_view word;        ///< of ?format=, and the end of a download's name
  std::string_view media_type;
};

constexpr std::array<FormatInfo, 4> kFormats{{{TableFormat::kJson, "json", "application/json"},
                                              {TableFormat::kCsv, "csv", "text/csv"},
                                              {TableFormat::kNdjson, "ndjson", "application/x-ndjson"},
                                              {TableFormat::kNpz, "npz", "application/x-npz"}}};

const FormatInfo& info_of(TableFormat format) {
  return *std::find_if(kFormats.begin(), kFormats.end(), [&](const FormatInfo& info) { return info.format == format; });
}

/// The one of these formats that an Accept header wants most; the first if it wants none.
TableFormat accepted(const std::string& accept, std::initializer_list<TableFormat> formats) {
  std::vector<std::string_view> media_types;
  for (const TableFormat format : formats) media_types.push_back(info_of(format).media_type);
  return formats.begin()[find_accepted(accept, media_types).value_or(0)];
}

TableFormat find_format(const Request& request, Query& query, std::initializer_list<TableFormat> formats, std::initializer_list<std::string_view> words) {
  const auto word = query.word("format", words);
  for (const TableFormat format : formats) {
    if (word && info_of(format).word == *word) return format;
  }
  return accepted(request.accept, formats);
}

void append_cell_to(std::string& text, const nlohmann::json& cell) {
  if (cell.is_number_float()) {
    append_number_to(text, cell.get<double>());
  } else {
    text += to_text(cell);
  }
}

void append_optional_to(std::string& text, const std::optional<double>& value) {
  if (value) {
    append_number_to(text, *value);
  } else {
    text += "null";
  }
}

/// The keys are the columns of the CSV.
void append_replicates_to(std::string& text, const jobs::ReplicateStatistics& set) {
  text += "\"replicates_count\":" + std::to_string(set.count);
  for (const auto& [key, value] : {std::pair{"mean", set.mean}, {"spread", set.spread}, {"min", set.min}, {"max", set.max}}) {
    text += std::string(",\"replicates_") + key + "\":";
    append_optional_to(text, value);
  }
}

/// `"key":` of every column, made once for all rows.
std::vector<std::string> quoted_keys(const std::vector<std::string>& columns) {
  std::vector<std::string> keys;
  for (const std::string& column : columns) {
    std::string key;
    append_string_to(key, column);
    keys.push_back(key + ":");
  }
  return keys;
}

/// An object for each row. @param before_first, before  what stands before it
std::string joined_rows(const jobs::ResultTable& table, const char* before_first, const char* before) {
  const auto keys = quoted_keys(table.columns);
  std::string text;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    text += r == 0 ? before_first : before;
    text += '{';
    for (std::size_t c = 0; c < keys.size(); ++c) {
      if (c > 0) text += ',';
      text += keys[c];
      append_cell_to(text, table.rows[r].at(c));
    }
    if (!table.replicates.empty()) {
      if (!keys.empty()) text += ',';
      append_replicates_to(text, table.replicates.at(r));
    }
    text += '}';
  }
  return text;
}

}  // namespace

TableFormat find_row_format(const Request& request, Query& query) {
  return find_format(request, query, {TableFormat::kJson, TableFormat::kCsv, TableFormat::kNdjson}, {"csv", "json", "ndjson"});
}

TableFormat find_column_format(const Request& request, Query& query) {
  return find_format(request, query, {TableFormat::kJson, TableFormat::kCsv, TableFormat::kNpz}, {"csv", "json", "npz"});
}

std::string to_json_rows(const jobs::ResultTable& table) { return table.rows.empty() ? "[\n]\n" : joined_rows(table, "[\n", ",\n") + "\n]\n"; }

std::string to_json_lines(const jobs::ResultTable& table) {
  return table.rows.empty() ? "" : joined_rows(table, "", "\n") + "\n";
}

std::string to_text(const jobs::ResultTable& table, TableFormat format) {
  if (format == TableFormat::kCsv) return jobs::to_csv(table);
  return format == TableFormat::kNdjson ? to_json_lines(table) : to_json_rows(table);
}

std::string to_json_columns(const engine::Trajectory& trajectory) {
  std::string text = "{\"channels\":[";
  for (std::size_t c = 0; c < trajectory.channels.size(); ++c) {
    if (c > 0) text += ',';
    append_string_to(text, trajectory.channels[c].key);
  }
  text += "],\n\"columns\":{";
  for (std::size_t c = 0; c < trajectory.channels.size(); ++c) {
    text += c == 0 ? "\n" : ",\n";
    append_string_to(text, trajectory.channels[c].key);
    text += ":[";
    for (std::size_t i = 0; i < trajectory.columns[c].size(); ++i) {
      if (i > 0) text += ',';
      append_number_to(text, trajectory.columns[c][i]);
    }
    text += ']';
  }
  text += "\n}}\n";
  return text;
}

Response make_table(TableFormat format, std::string text, const std::string& file_stem) {
  Response response;
  response.body = std::move(text);
  response.headers = {{"Vary", "Accept"}};
  const FormatInfo& info = info_of(format);
  response.content_type = std::string(info.media_type) + (format == TableFormat::kCsv ? "; charset=utf-8" : "");
  if (format == TableFormat::kCsv || format == TableFormat::kNpz) {
    response.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + file_stem + "." + std::string(info.word) + "\"");
  }
  return response;
}

}  // namespace server
