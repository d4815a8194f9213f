#include <array>
#include <cmath>

#include "jobs/range.h"
#include "jobs/service.h"

namespace jobs {
namespace {

constexpr const char* kLineEnd = "\r\n";

/// A text cell. One that a spreadsheet would take for a formula is made plain text by a leading apostrophe.
std::string text_cell(std::string text) {
  constexpr std::string_view kFormulaStarts = "=+-@\t\r";
  if (!text.empty() && kFormulaStarts.find(text.front()) != std::string_view::npos) text.insert(0, "'");
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

std::string number_cell(double x) { return std::isfinite(x) ? number_text(x) : ""; }

std::string number_cell(const std::optional<double>& x) { return x ? number_cell(*x) : ""; }

std::string cell(const nlohmann::json& value) {
  if (value.is_null()) return "";
  if (value.is_number_float()) return number_cell(value.get<double>());
  if (value.is_string()) return text_cell(value.get<std::string>());
  if (value.is_structured()) return text_cell(value.dump());
  return value.dump();  // integers and booleans
}

constexpr std::array<const char*, 5> kReplicateColumns{"replicates_count", "replicates_mean", "replicates_spread", "replicates_min", "replicates_max"};

/// Their cells, each after a comma: other columns stand before them.
std::string replicate_cells(const ReplicateStatistics& set) {
  std::string cells = "," + std::to_string(set.count);
  for (const auto& value : {set.mean, set.spread, set.min, set.max}) cells += "," + number_cell(value);
  return cells;
}

}  // namespace

std::string to_csv(const ResultTable& table) {
  std::string csv;
  for (std::size_t i = 0; i < table.columns.size(); ++i) csv += (i > 0 ? "," : "") + text_cell(table.columns[i]);
  if (!table.replicates.empty()) {
    for (const char* column : kReplicateColumns) csv += std::string(",") + column;
  }
  csv += kLineEnd;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto& row = table.rows[r];
    for (std::size_t i = 0; i < row.size(); ++i) csv += (i > 0 ? "," : "") + cell(row[i]);
    if (!table.replicates.empty()) csv += replicate_cells(table.replicates.at(r));
    csv += kLineEnd;
  }
  return csv;
}

std::string to_csv(const engine::Trajectory& trajectory) {
  std::string csv;
  for (std::size_t i = 0; i < trajectory.channels.size(); ++i) csv += (i > 0 ? "," : "") + text_cell(trajectory.channels[i].key);
  csv += kLineEnd;
  const std::size_t samples = trajectory.columns.empty() ? 0 : trajectory.columns.front().size();
  for (std::size_t k = 0; k < samples; ++k) {
    for (std::size_t i = 0; i < trajectory.columns.size(); ++i) csv += (i > 0 ? "," : "") + number_cell(trajectory.columns[i][k]);
    csv += kLineEnd;
  }
  return csv;
}

}  // namespace jobs
