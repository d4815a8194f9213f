// SPDX-License-Identifier: Apache-2.0
#include "validation/report.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace validation {

namespace {

std::string format(const char* pattern, int digits, double value) {
  char text[48];
  std::snprintf(text, sizeof text, pattern, digits, value);
  return text;
}

/// A number to a tenth of what the comparison resolves.
std::string format_to(double value, double resolution) {
  if (!std::isfinite(value)) return "";
  const double magnitude = std::abs(value);
  if (magnitude == 0.0) return "0";
  const double digits = std::ceil(std::log10(std::max(magnitude / resolution, 1.0))) + 2.0;  // infinite for a bound of zero
  return format("%.*g", static_cast<int>(std::clamp(digits, 3.0, 13.0)), value);
}

std::string format_difference(double value) { return value == 0.0 ? "0" : format("%.*g", 2, value); }

/// A bar would end the cell.
std::string cell(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '|' ? "\\|" : std::string(1, c);
  return safe;
}

std::string row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& text : cells) line += " " + cell(text) + " |";
  return line;
}

std::string rule(std::size_t columns) {
  std::string line = "|";
  for (std::size_t k = 0; k < columns; ++k) line += "---|";
  return line;
}

class ReportWriter {
 public:
  explicit ReportWriter(const std::string& figure_folder) : figure_folder_(figure_folder) {}

  void add(const std::string& text, std::vector<Tolerance> cells = {}) { lines_.push_back({text, std::move(cells)}); }

  void add_chapter(const ComputedChapter& computed, std::size_t number) {
    add("## " + std::to_string(number) + " " + computed.chapter.title);
    add("");
    if (!computed.chapter.text.empty()) {
      add_paragraph(computed.chapter.text);
      add("");
    }
    add_checks(computed);
    for (const Findings& findings : computed.findings) {
      for (const Table& table : findings.tables) add_table(table);
      for (const Figure& figure : findings.figures) add_figure(figure);
    }
  }

  void add_faults_chapter(std::size_t number) {
    add("## " + std::to_string(number) + " Planted faults");
    add("");
    add("A proof that cannot fail proves nothing. `script/faults` plants a fault in a copy of the engine, one after the other (a sign, a factor");
    add("2, a term left out, a frame exchanged), and runs the engine's light tests, of which the parts of the chapters above are most.");
    add("`tests/faults/faults.txt` lists them; the table names the first test that failed with each. `script/faults --report validation/VALIDATION.md` runs all and replaces it.");
    add("");
    add(kFaultsBegin);
    add(kFaultsEnd);
  }

  std::vector<ReportLine> take() { return std::move(lines_); }

 private:
  void add_paragraph(const std::string& text) {
    std::size_t from = 0;
    while (from <= text.size()) {
      const std::size_t to = std::min(text.find('\n', from), text.size());
      add(text.substr(from, to - from));
      from = to + 1;
    }
  }

  void add_checks(const ComputedChapter& computed) {
    const bool any = std::any_of(computed.findings.begin(), computed.findings.end(), [](const Findings& f) { return !f.checks.empty(); });
    if (!any) return;
    const std::vector<std::string> head{"compared", "with", "found", "expected", "unit", "difference", "bound", "why this bound"};
    add(row(head));
    add(rule(head.size()));
    for (const Findings& findings : computed.findings)
      for (const Check& check : findings.checks) {
        const std::string difference = format_difference(check.difference) + (check.holds() ? "" : " **FAILED**");
        add(row({check.what, check.reference, format_to(check.found, 0.1 * check.bound), format_to(check.expected, 0.1 * check.bound),
                 check.unit, difference, format("%.*g", 3, check.bound), check.why}),
            {{}, {}, {.absolute = check.bound}, {.absolute = check.bound}, {}, {.factor = 30.0, .floor = 0.1 * check.bound}, {.relative = 1e-3}, {}});
      }
    add("");
  }

  void add_table(const Table& table) {
    add(table.caption, {tolerance_of(table.reproducible_to)});
    add("");
    add(row(table.head));
    add(rule(table.head.size()));
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
      const double to = table.row_reproducible_to.empty() ? table.reproducible_to : table.row_reproducible_to.at(k);
      add(row(table.rows[k]), std::vector<Tolerance>(table.rows[k].size(), tolerance_of(to)));
    }
    add("");
  }

  void add_figure(const Figure& figure) {
    add("![" + figure.caption + "](" + figure_folder_ + "/" + figure.file + ")");
    add("");
    add("*" + figure.caption + "*");
    add("");
  }

  static Tolerance tolerance_of(double reproducible_to) {
    if (reproducible_to < 1.0) return {.relative = reproducible_to};
    return {.factor = reproducible_to, .floor = 1e-6};
  }

  std::string figure_folder_;
  std::vector<ReportLine> lines_;
};

/// A text cut into its numbers and what stands between them.
struct Pieces {
  std::vector<double> numbers;
  std::string rest;  ///< a '#' for each number
};

bool begins_number(const std::string& text, std::size_t at) {
  if (at > 0 && (std::isalnum(static_cast<unsigned char>(text[at - 1])) || text[at - 1] == '_' || text[at - 1] == '.')) return false;
  const std::size_t digit = text[at] == '-' ? at + 1 : at;
  return digit < text.size() && std::isdigit(static_cast<unsigned char>(text[digit]));
}

Pieces cut(const std::string& text) {
  Pieces pieces;
  for (std::size_t at = 0; at < text.size();) {
    if (!begins_number(text, at)) {
      pieces.rest += text[at++];
      continue;
    }
    char* end = nullptr;
    pieces.numbers.push_back(std::strtod(text.c_str() + at, &end));
    pieces.rest += '#';
    at = static_cast<std::size_t>(end - text.c_str());
  }
  return pieces;
}

/// The cells of a row of a table; other text is one cell.
std::vector<std::string> split_cells(const std::string& text) {
  if (!text.starts_with("| ")) return {text};
  std::vector<std::string> cells;
  for (std::size_t from = 2; from < text.size();) {
    const std::size_t to = std::min(text.find(" | ", from), text.size());
    cells.push_back(text.substr(from, to - from));
    from = to + 3;
  }
  return cells;
}

bool cells_agree(const std::string& fresh, const std::string& written, const Tolerance& tolerance) {
  if (fresh == written) return true;
  const Pieces a = cut(fresh);
  const Pieces b = cut(written);
  if (a.rest != b.rest || a.numbers.size() != b.numbers.size()) return false;
  for (std::size_t k = 0; k < a.numbers.size(); ++k)
    if (!tolerance.allows(a.numbers[k], b.numbers[k])) return false;
  return true;
}

bool says_the_same(const ReportLine& fresh, const std::string& written) {
  if (fresh.text == written) return true;
  const auto a = split_cells(fresh.text);
  const auto b = split_cells(written);
  if (a.size() != b.size() || a.size() != fresh.cells.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (!cells_agree(a[k], b[k], fresh.cells[k])) return false;
  return true;
}

}  // namespace

bool Tolerance::allows(double a, double b) const {
  if (a == b) return true;
  const double most = std::max(std::abs(a), std::abs(b));
  const double least = std::min(std::abs(a), std::abs(b));
  if (std::abs(a - b) <= std::max(absolute, relative * most)) return true;
  return most <= floor || (a * b > 0.0 && most <= factor * least);
}

std::vector<ReportLine> write_report(const std::vector<ComputedChapter>& chapters, const std::string& figure_folder) {
  ReportWriter report(figure_folder);
  const Counts counts = count_checks(chapters);
  report.add("# Why the numbers may be believed");
  report.add("");
  report.add("Each line below compares the engine with a result that it did not compute itself: a closed form, a published number, another");
  report.add("code; or, where the line says so, with what it finds by another route: from its energies, with another integrator, another way");
  report.add("to enforce the drives, other tolerances. Every number and figure was written by `rpsup-validate --report validation/VALIDATION.md`;");
  report.add("each line is a test as well, and a test runs `rpsup-validate --check validation/VALIDATION.md`, which computes all of it again and");
  report.add("compares. A bound is what the difference may be, with its reason beside it: rounding, truncation, or the digits that are known.");
  report.add("");
  report.add(std::to_string(counts.checks) + " comparisons, " +
             (counts.failed == 0 ? "all within their bounds." : std::to_string(counts.failed) + " **outside their bounds**."));
  report.add("");
  for (std::size_t k = 0; k < chapters.size(); ++k) report.add_chapter(chapters[k], k + 1);
  report.add_faults_chapter(chapters.size() + 1);
  return report.take();
}

WrittenReport take_faults(const std::vector<std::string>& written) {
  WrittenReport report;
  bool inside = false;
  for (const std::string& line : written) {
    if (line == kFaultsEnd) inside = false;
    (inside ? report.faults : report.lines).push_back(line);
    if (line == kFaultsBegin) inside = true;
  }
  return report;
}

std::string to_text(const std::vector<ReportLine>& lines, const std::vector<std::string>& faults) {
  std::string text;
  for (const ReportLine& line : lines) {
    text += line.text + '\n';
    if (line.text != kFaultsBegin) continue;
    for (const std::string& fault : faults) text += fault + '\n';
  }
  return text;
}

Counts count_checks(const std::vector<ComputedChapter>& chapters) {
  Counts counts;
  for (const ComputedChapter& computed : chapters)
    for (const Findings& findings : computed.findings)
      for (const Check& check : findings.checks) {
        ++counts.checks;
        counts.failed += check.holds() ? 0 : 1;
      }
  return counts;
}

std::string describe(const Check& check) {
  std::string text = (check.holds() ? "ok      " : "FAILED  ") + check.what + ": difference " + format_difference(check.difference);
  if (check.unit != "1") text += " " + check.unit;
  return text + ", bound " + format("%.*g", 3, check.bound);
}

std::vector<std::string> find_differences(const std::vector<ReportLine>& fresh, const std::vector<std::string>& written) {
  std::vector<std::string> differences;
  for (std::size_t k = 0; k < std::max(fresh.size(), written.size()); ++k) {
    const std::string place = "line " + std::to_string(k + 1) + ": ";
    if (k >= written.size()) {
      differences.push_back(place + "missing: " + fresh[k].text);
    } else if (k >= fresh.size()) {
      differences.push_back(place + "no longer written: " + written[k]);
    } else if (!says_the_same(fresh[k], written[k])) {
      differences.push_back(place + "written: " + written[k] + "\n  fresh:   " + fresh[k].text);
    }
  }
  return differences;
}

}  // namespace validation
