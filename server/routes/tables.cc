// SPDX-License-Identifier: Apache-2.0
#include "server/routes/tables.h"

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/results/csv.h"
#include "jobs/results/table_json.h"
#include "server/messages/accept.h"

namespace server {

namespace {

/// The one of the formats of a shape that an Accept header wants most; the first if it wants none.
TableFormat accepted(const std::string& accept, DataShape shape) {
  const auto formats = formats_of(shape);
  std::vector<std::string_view> media_types;
  for (const FormatInfo& info : formats) media_types.push_back(info.media_type);
  return formats[find_accepted(accept, media_types).value_or(0)].format;
}

TableFormat find_asked_format(const Request& request, Query& query, DataShape shape) {
  const auto word = query.word("format", format_words(shape));
  const auto format = word ? find_format(*word) : std::nullopt;
  return format ? *format : accepted(request.accept, shape);
}

}  // namespace

TableFormat find_row_format(const Request& request, Query& query) {
  return find_asked_format(request, query, DataShape::kRows);
}

TableFormat find_column_format(const Request& request, Query& query) {
  return find_asked_format(request, query, DataShape::kColumns);
}

TableFormat find_trajectories_format(const Request& request, Query& query) {
  return find_asked_format(request, query, DataShape::kTrajectories);
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
