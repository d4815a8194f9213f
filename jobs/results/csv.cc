// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "engine/analysis/quantities.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/results/result_table.h"

namespace jobs {
namespace {

constexpr const char* kLineEnd = "\r\n";

/// @returns whether a parameter may have a word as its value: "-z"
bool is_choice(std::string_view word) {
  return std::ranges::any_of(parameter_table(), [word](const ParameterInfo& info) {
    return std::ranges::find(info.choices, word) != info.choices.end();
  });
}

/// A text cell. One that a spreadsheet would take for a formula is made plain text by a leading apostrophe,
/// unless it is the value of a parameter.
std::string text_cell(std::string text) {
  constexpr std::string_view kFormulaStarts = "=+-@\t\r";
  if (!text.empty() && kFormulaStarts.find(text.front()) != std::string_view::npos && !is_choice(text))
    text.insert(0, "'");
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

void append_number_cell(std::string& csv, double x) {
  if (!std::isfinite(x)) return;
  std::array<char, 32> digits;  // the longest double takes 24 characters
  csv.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
}

void append_cell(std::string& csv, const nlohmann::json& value) {
  if (value.is_null()) return;
  if (value.is_number_float()) return append_number_cell(csv, value.get<double>());
  csv += value.is_string()       ? text_cell(value.get<std::string>())
         : value.is_structured() ? text_cell(value.dump())
                                 : value.dump();
}

constexpr std::array<const char*, 5> kReplicateColumns{
    "replicates_count", "replicates_mean", "replicates_spread", "replicates_min", "replicates_max"};

void append_head(std::string& csv, const ResultTable& table) {
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    csv += (i > 0 ? "," : "") + text_cell(table.columns[i]);
  if (!table.replicates.empty()) {
    for (const char* column : kReplicateColumns) csv += std::string(",") + column;
  }
  csv += kLineEnd;
}

/// Their cells, each after a comma: other columns stand before them.
void append_replicate_cells(std::string& csv, const ReplicateStatistics& set) {
  csv += "," + std::to_string(set.count);
  for (const auto& value : {set.mean, set.spread, set.min, set.max}) {
    csv += ',';
    if (value) append_number_cell(csv, *value);
  }
}

}  // namespace

std::string to_csv(const ResultTable& table) {
  std::string csv;
  append_head(csv, table);
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto& row = table.rows[r];
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) csv += ',';
      append_cell(csv, row[i]);
    }
    if (!table.replicates.empty()) append_replicate_cells(csv, table.replicates.at(r));
    csv += kLineEnd;
  }
  return csv;
}

void append_csv_head(std::string& csv, const std::vector<engine::QuantityInfo>& channels) {
  for (std::size_t i = 0; i < channels.size(); ++i) csv += (i > 0 ? "," : "") + text_cell(channels[i].key);
  csv += kLineEnd;
}

void append_csv_row(std::string& csv, const std::vector<std::vector<double>>& columns, std::size_t row) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) csv += ',';
    append_number_cell(csv, columns[i][row]);
  }
  csv += kLineEnd;
}

std::string to_csv(const engine::Trajectory& trajectory) {
  std::string csv;
  append_csv_head(csv, trajectory.channels);
  const std::size_t samples = trajectory.columns.empty() ? 0 : trajectory.columns.front().size();
  for (std::size_t k = 0; k < samples; ++k) append_csv_row(csv, trajectory.columns, k);
  return csv;
}

}  // namespace jobs
