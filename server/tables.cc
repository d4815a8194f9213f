#include "server/tables.h"

#include <optional>
#include <utility>

#include "server/json_text.h"

namespace server {

namespace {

bool prefers_csv(const std::string& accept) {
  const auto csv = accept.find("text/csv");
  return csv != std::string::npos && csv < accept.find("application/json");
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

}  // namespace

TableFormat find_format(const Request& request, Query& query) {
  const auto format = query.word("format", {"csv", "json"});
  if (format) return *format == "csv" ? TableFormat::kCsv : TableFormat::kJson;
  return prefers_csv(request.accept) ? TableFormat::kCsv : TableFormat::kJson;
}

std::string to_json_rows(const jobs::ResultTable& table) {
  const auto keys = quoted_keys(table.columns);
  std::string text = "[";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    text += r == 0 ? "\n{" : ",\n{";
    for (std::size_t c = 0; c < keys.size(); ++c) {
      if (c > 0) text += ',';
      text += keys[c];
      append_cell_to(text, table.rows[r].at(c));
    }
    if (!table.replicates.empty()) {
      text += ',';
      append_replicates_to(text, table.replicates.at(r));
    }
    text += '}';
  }
  return text + "\n]\n";
}

std::string to_json_columns(const engine::Trajectory& trajectory) {
  std::string channels;
  std::string columns;
  for (std::size_t c = 0; c < trajectory.channels.size(); ++c) {
    const char* const separator = c == 0 ? "" : ",";
    channels += separator;
    append_string_to(channels, trajectory.channels[c].key);
    columns += separator + std::string("\n");
    append_string_to(columns, trajectory.channels[c].key);
    columns += ":[";
    for (std::size_t i = 0; i < trajectory.columns[c].size(); ++i) {
      if (i > 0) columns += ',';
      append_number_to(columns, trajectory.columns[c][i]);
    }
    columns += ']';
  }
  return "{\"channels\":[" + channels + "],\n\"columns\":{" + columns + "\n}}\n";
}

Response make_table(TableFormat format, std::string text, const std::string& file_stem) {
  Response response;
  response.body = std::move(text);
  response.headers = {{"Vary", "Accept"}};
  if (format == TableFormat::kJson) {
    response.content_type = "application/json";
  } else {
    response.content_type = "text/csv; charset=utf-8";
    response.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + file_stem + ".csv\"");
  }
  return response;
}

}  // namespace server
