// SPDX-License-Identifier: Apache-2.0
#include "jobs/exports/table_column.h"

#include <algorithm>
#include <limits>

#include "jobs/measurements/channel_unit.h"
#include "jobs/requests/path_unit.h"

namespace jobs {
namespace {

using nlohmann::json;

bool is_number(const json& cell) { return cell.is_number() || cell.is_boolean() || cell.is_null(); }

double number_of(const json& cell) {
  if (cell.is_null()) return std::numeric_limits<double>::quiet_NaN();
  return cell.is_boolean() ? static_cast<double>(cell.get<bool>()) : cell.get<double>();
}

std::string cell_text(const json& cell) {
  if (cell.is_null()) return "";
  return cell.is_string() ? cell.get<std::string>() : cell.dump();
}

/// In the spelling of channels: "m/s²"
std::string unit_of_column(const std::string& name) {
  std::optional<std::string> unit = find_path_unit(name);
  if (!unit) return std::string(find_unit(name).value_or(""));
  if (const std::size_t square = unit->find("^2"); square != std::string::npos)
    unit->replace(square, 2, "²");
  return *unit;
}

}  // namespace

std::vector<char32_t> code_points_of(const std::string& text) {
  std::vector<char32_t> points;
  for (std::size_t k = 0; k < text.size();) {
    const auto first = static_cast<unsigned char>(text[k]);
    const std::size_t length = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    char32_t point = length == 1 ? first : first & (0xffU >> (length + 1));
    for (std::size_t i = 1; i < length && k + i < text.size(); ++i)
      point = (point << 6U) | (static_cast<unsigned char>(text[k + i]) & 0x3fU);
    points.push_back(point);
    k += length;
  }
  return points;
}

std::vector<TableColumn> to_columns(const ResultTable& table) {
  std::vector<TableColumn> columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    TableColumn& column = columns.emplace_back();
    column.name = table.columns[c];
    column.is_text = !std::ranges::all_of(table.rows, [c](const auto& row) { return is_number(row[c]); });
    if (!column.is_text) column.unit = unit_of_column(column.name);
    for (const auto& row : table.rows) {
      if (column.is_text) column.texts.push_back(cell_text(row[c]));
      else column.numbers.push_back(number_of(row[c]));
    }
  }
  return columns;
}

}  // namespace jobs
