// SPDX-License-Identifier: Apache-2.0
#include "validation/report/rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "validation/support/text.h"

namespace validation {

namespace {

/// Record of rows.csv. A comparison states its case in `quantity`; a number of a table has no reference.
struct Row {
  std::string chapter{};
  std::string section{};     ///< the chapter's part
  std::string where{};       ///< case: row of a table
  std::string quantity{};
  std::string unit{};
  std::string ours{};
  std::string reference{};
  std::string source{};      ///< of the reference
  std::string difference{};
  std::string bound{};
  std::string holds{};       ///< "yes" or "no"
  std::string note{};        ///< reason for the bound; with a table's first number: caption of the table
};

constexpr const char* kHead =
    "chapter,section,case,quantity,unit,ours,reference,source,difference,bound,holds,note";

std::string quote(const std::string& field) {
  if (field.find_first_of(",\"\n") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string join(const Row& row) {
  std::string line = quote(row.chapter);
  for (const std::string* field :
       {&row.section, &row.where, &row.quantity, &row.unit, &row.ours, &row.reference, &row.source,
        &row.difference, &row.bound, &row.holds, &row.note})
    line += ',' + quote(*field);
  return line;
}

/// Number to a tenth of the resolution of its comparison; empty for a value that is not finite.
std::string number_to(double value, double resolution) {
  if (!std::isfinite(value)) return "";
  if (value == 0.0) return "0";
  const double parts = std::max(std::abs(value) / resolution, 1.0);  // infinite for a resolution of zero
  return number(value, static_cast<int>(std::clamp(std::ceil(std::log10(parts)) + 2.0, 3.0, 13.0)));
}

/// "speed [m/s]" as "speed" and "m/s".
std::pair<std::string, std::string> split_unit(const std::string& head) {
  const std::size_t at = head.rfind(" [");
  if (at == std::string::npos || !head.ends_with(']')) return {head, ""};
  return {head.substr(0, at), head.substr(at + 2, head.size() - at - 3)};
}

/// Leading cells of a row; a number with its head and unit, "depth 0.5 um".
std::string case_of(const Table& table, std::size_t row) {
  std::string text;
  for (std::size_t column = 0; column < table.keys; ++column) {
    std::string cell = table.rows[row].at(column);
    if (cell.empty()) continue;
    if (cell.find_first_not_of("0123456789.e+-") == std::string::npos) {
      const auto [quantity, unit] = split_unit(table.head.at(column));
      cell = quantity + ' ' + cell + (unit.empty() ? "" : ' ' + unit);
    }
    text += (text.empty() ? "" : ", ") + cell;
  }
  return text;
}

class RowWriter {
 public:
  void add_chapter(const ComputedChapter& computed) {
    const auto& parts = computed.chapter.parts;
    for (std::size_t k = 0; k < computed.findings.size(); ++k) {
      const std::string section = k < parts.size() ? parts[k].name : "";
      const Findings& findings = computed.findings[k];
      for (const Check& check : findings.checks) add_check(computed.chapter.name, section, check);
      for (const Table& table : findings.tables) add_table(computed.chapter.name, section, table);
    }
  }

  std::vector<ReportLine> take() { return std::move(lines_); }

 private:
  void add_check(const std::string& chapter, const std::string& section, const Check& check) {
    const Tolerance value{.absolute = check.bound};
    const Tolerance difference{.factor = 30.0, .floor = 0.1 * check.bound};
    const Tolerance bound{.relative = 1e-3};
    lines_.push_back({join({.chapter = chapter,
                            .section = section,
                            .quantity = check.what,
                            .unit = check.unit,
                            .ours = number_to(check.found, 0.1 * check.bound),
                            .reference = number_to(check.expected, 0.1 * check.bound),
                            .source = check.reference,
                            .difference = number(check.difference, 2),
                            .bound = number(check.bound),
                            .holds = check.holds() ? "yes" : "no",
                            .note = check.why}),
                      {{}, {}, {}, {}, {}, value, value, {}, difference, bound, {}, {}}});
  }

  void add_table(const std::string& chapter, const std::string& section, const Table& table) {
    std::string note = table.caption;
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
      const Tolerance to = tolerance_of_row(table, k);
      for (std::size_t column = table.keys; column < table.rows[k].size(); ++column) {
        if (table.rows[k][column].empty()) continue;
        const auto [quantity, unit] = split_unit(table.head.at(column));
        lines_.push_back({join({.chapter = chapter,
                                .section = section,
                                .where = case_of(table, k),
                                .quantity = quantity,
                                .unit = unit,
                                .ours = table.rows[k][column],
                                .note = std::exchange(note, "")}),
                          {{}, {}, to, {}, {}, to, {}, {}, {}, {}, {}, tolerance_of(table)}});
      }
    }
  }

  std::vector<ReportLine> lines_{{kHead}};
};

}  // namespace

std::vector<ReportLine> write_rows(const std::vector<ComputedChapter>& chapters) {
  RowWriter writer;
  for (const ComputedChapter& chapter : chapters) writer.add_chapter(chapter);
  return writer.take();
}

}  // namespace validation
