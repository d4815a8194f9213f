// SPDX-License-Identifier: Apache-2.0
#include "server/commands/paper.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/paper/paper_statements.h"
#include "jobs/results/result_table.h"
#include "server/commands/command.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

using nlohmann::json;

std::string format_number(const char* form, double value) {
  char text[64];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

void add_result_rows(const json& rows, const std::string& file, jobs::ResultTable& table) {
  if (!rows.is_array())
    throw BadInput(file + ": is no list of rows, as rpsup sweep FILE --results NAME.json writes it");
  for (const json& row : rows) {
    if (!row.is_object()) throw BadInput(file + ": a row is no object");
    for (const auto& [key, value] : row.items())
      if (std::ranges::find(table.columns, key) == table.columns.end()) table.columns.push_back(key);
    std::vector<json> cells;
    for (const std::string& column : table.columns) cells.push_back(row.value(column, json()));
    table.rows.push_back(std::move(cells));
  }
}

/// One row of the answer by its columns.
using Row = std::map<std::string, json>;

std::vector<Row> rows_of(const jobs::ResultTable& table) {
  std::vector<Row> rows;
  for (const auto& cells : table.rows) {
    Row row;
    for (std::size_t k = 0; k < cells.size(); ++k) row[table.columns[k]] = cells[k];
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string found_text(const Row& row) {
  if (row.at("found_least").is_null()) return "-";
  const std::string least = format_number("%.3g", row.at("found_least").get<double>()),
                    largest = format_number("%.3g", row.at("found_largest").get<double>());
  return least == largest ? least : least + " to " + largest;
}

std::string paper_text(const Row& row) {
  if (!row.at("paper").is_null()) return format_number("%g", row.at("paper").get<double>());
  return row.at("number").is_null() ? "" : "below 1";
}

std::string verdict_text(const Row& row) {
  if (row.at("share").is_null()) return "-";
  if (row.at("settings").get<std::size_t>() > 1)
    return format_number("in %.3g %%", 100.0 * row.at("share").get<double>());
  return row.at("holds").get<bool>() ? "holds" : "does not hold";
}

std::string pad(std::string text, std::size_t width) {
  if (text.size() < width) text.append(width - text.size(), ' ');
  return text;
}

std::string make_statement_table(const std::vector<Row>& rows) {
  constexpr std::size_t kNumber = 3, kText = 90, kPaper = 9, kFound = 18;
  std::string text = pad("", kNumber) + pad("ratio of peak slider accelerations", kText) +
                     pad("paper", kPaper) + pad("here", kFound) + "\n";
  for (const Row& row : rows)
    text += pad(row.at("number").is_null() ? "" : std::to_string(row.at("number").get<int>()), kNumber) +
            pad(row.at("text").get<std::string>(), kText) + pad(paper_text(row), kPaper) +
            pad(found_text(row), kFound) + verdict_text(row) + "\n";
  return text;
}

/// Sensitivity indices of a ratio by parameter, the largest first, without negligible ones.
std::vector<std::pair<double, std::string>> find_indices(const Row& row) {
  constexpr double kNegligible = 0.02;
  std::vector<std::pair<double, std::string>> indices;
  for (const auto& [column, value] : row)
    if (column.starts_with("index.") && value.is_number() && value.get<double>() >= kNegligible)
      indices.emplace_back(value.get<double>(), column.substr(column.find('.') + 1));
  std::ranges::sort(indices, std::greater<>());
  return indices;
}

/// For each of the seven the parameters that decide it, most first.
std::string make_index_table(const std::vector<Row>& rows) {
  std::string text = "\nfirst-order sensitivity indices of each ratio (those of 0.02 and more)\n";
  for (const Row& row : rows) {
    if (row.at("number").is_null()) continue;
    text += pad(std::to_string(row.at("number").get<int>()), 3);
    for (const auto& [index, parameter] : find_indices(row))
      text += terminal_text(parameter) + format_number(" %.2f  ", index);
    text += "\n";
  }
  return text;
}

}  // namespace

int hold_against_paper(const PaperOptions& options) {
  jobs::ResultTable results;
  for (const std::string& file : options.files) add_result_rows(json(read_json(file)), file, results);
  for (auto& row : results.rows) row.resize(results.columns.size());
  jobs::ResultTable table;
  try {
    table = jobs::hold_against_paper(results);
  } catch (const jobs::WrongState& unfit) {
    throw BadInput(unfit.what());
  }
  const std::vector<Row> rows = rows_of(table);
  const bool has_indices = std::ranges::any_of(
      table.columns, [](const std::string& column) { return column.starts_with("index."); });
  write_text("-", make_statement_table(rows) + (has_indices ? make_index_table(rows) : ""));
  return kDone;
}

}  // namespace server::commands
