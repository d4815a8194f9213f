// SPDX-License-Identifier: Apache-2.0
#include "server/routes/tables.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/results/csv.h"
#include "jobs/results/table_json.h"
#include "server/messages/accept.h"

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
  return *std::find_if(kFormats.begin(), kFormats.end(),
                       [&](const FormatInfo& info) { return info.format == format; });
}

/// The one of these formats that an Accept header wants most; the first if it wants none.
TableFormat accepted(const std::string& accept, std::initializer_list<TableFormat> formats) {
  std::vector<std::string_view> media_types;
  for (const TableFormat format : formats) media_types.push_back(info_of(format).media_type);
  return formats.begin()[find_accepted(accept, media_types).value_or(0)];
}

TableFormat find_format(const Request& request, Query& query, std::initializer_list<TableFormat> formats,
                        std::initializer_list<std::string_view> words) {
  const auto word = query.word("format", words);
  for (const TableFormat format : formats) {
    if (word && info_of(format).word == *word) return format;
  }
  return accepted(request.accept, formats);
}

}  // namespace

TableFormat find_row_format(const Request& request, Query& query) {
  return find_format(request, query, {TableFormat::kJson, TableFormat::kCsv, TableFormat::kNdjson},
                     {"csv", "json", "ndjson"});
}

TableFormat find_column_format(const Request& request, Query& query) {
  return find_format(request, query, {TableFormat::kJson, TableFormat::kCsv, TableFormat::kNpz},
                     {"csv", "json", "npz"});
}

std::string to_text(const jobs::ResultTable& table, TableFormat format) {
  if (format == TableFormat::kCsv) return jobs::to_csv(table);
  return format == TableFormat::kNdjson ? jobs::to_json_lines(table) : jobs::to_json_rows(table);
}

Response make_table(TableFormat format, std::string text, const std::string& file_stem) {
  Response response;
  response.body = std::move(text);
  response.headers = {{"Vary", "Accept"}};
  const FormatInfo& info = info_of(format);
  response.content_type =
      std::string(info.media_type) + (format == TableFormat::kCsv ? "; charset=utf-8" : "");
  if (format == TableFormat::kCsv || format == TableFormat::kNpz) {
    response.headers.emplace_back(
        "Content-Disposition", "attachment; filename=\"" + file_stem + "." + std::string(info.word) + "\"");
  }
  return response;
}

}  // namespace server
