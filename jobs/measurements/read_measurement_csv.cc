// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/read_measurement_csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/measurements/check_measurement.h"

namespace jobs {
namespace {

std::string_view trimmed_cell(std::string_view cell) {
  const auto begin = cell.find_first_not_of(" \t");
  return begin == std::string_view::npos ? std::string_view()
                                         : cell.substr(begin, cell.find_last_not_of(" \t") + 1 - begin);
}

/// Splits a line at the commas that are not in quotes. A cell in quotes loses them. False if a quote is not
/// closed.
bool split_line(std::string_view line, std::vector<std::string>& cells) {
  cells.assign(1, "");
  bool in_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && in_quotes && i + 1 < line.size() && line[i + 1] == '"') cells.back() += line[i++];
    else if (c == '"') in_quotes = !in_quotes;
    else if (c == ',' && !in_quotes) cells.emplace_back();
    else cells.back() += c;
  }
  return !in_quotes;
}

/// Number that has no double: zero if it is too small, else infinite.
double round_out_of_range(std::string_view cell) {
  const auto exponent = cell.find_first_of("eE");
  const bool is_small = exponent == std::string_view::npos ? cell.find_first_of("123456789") > cell.find('.')
                                                           : cell.substr(exponent + 1).starts_with('-');
  return is_small ? 0.0 : std::numeric_limits<double>::infinity();
}

/// Number of a cell; empty if it is none. A sign '+' is taken as well.
std::optional<double> find_number(std::string_view cell) {
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') cell.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  if (end != cell.data() + cell.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return round_out_of_range(cell);
  return error == std::errc{} ? std::optional(number) : std::nullopt;
}

/// Fault of a cell that is no finite number.
std::string describe_cell(std::string_view cell) {
  if (cell.empty()) return std::string("is empty; ") + kNoGaps;
  if (find_number(cell)) return quoted_text(cell) + " is not finite; " + kNoGaps;
  std::string detail = quoted_text(cell) + " is no number";
  std::string with_point(cell);
  std::ranges::replace(with_point, ',', '.');
  if (with_point != cell && find_number(with_point)) detail += "; write a decimal point";
  return detail;
}

/// Reads a file line by line.
class CsvReader {
 public:
  CsvReader(std::string_view text, const ColumnQuery& query) : rest_(text), query_(query) {}

  Measurement read() {
    read_names();
    while (next_line()) read_samples();
    throw_if_any(faults_);
    add_time_faults(
        run_.time_s,
        [this](std::size_t k, const std::string& text) {
          return Fault{"", place(lines_[k], choice_.time) + ": " + text};
        },
        {"", "the file has " + std::to_string(run_.time_s.size()) + " samples; at least " +
                 std::to_string(kFewestMeasuredSamples) + " are needed"},
        faults_);
    throw_if_any(std::move(faults_));
    return {.name = query_.name, .channels = std::move(choice_.channels), .runs = {std::move(run_)}};
  }

 private:
  [[nodiscard]] std::string place(std::size_t line, std::size_t column) const {
    return "line " + std::to_string(line) + ", column " + std::to_string(column + 1) + " (" +
           shown_text(names_[column]) + ")";
  }

  /// Takes the next line. False at the end of the text.
  bool next_line() {
    if (rest_.empty()) return false;
    const auto end = std::min(rest_.find('\n'), rest_.size());
    text_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (text_.ends_with('\r')) text_.remove_suffix(1);
    ++line_;
    return true;
  }

  void read_names() {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
    if (!next_line()) refuse_body("the file is empty; its first line must name the columns");
    if (!split_line(text_, names_)) refuse_body("line 1: a quotation mark is not closed");
    for (std::string& name : names_) name = std::string(trimmed_cell(name));
    check_separator();
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (names_[i].empty()) refuse_body("line 1, column " + std::to_string(i + 1) + " has no name");
    if (std::ranges::all_of(names_, [](const std::string& name) { return find_number(name).has_value(); }))
      refuse_body("line 1 holds numbers; the first line must name the columns");
    choice_ = choose_columns(names_, query_, [this](std::size_t column) { return place(1, column); });
    run_.parameters = choice_.parameters;
    run_.columns.resize(choice_.columns.size());
  }

  void check_separator() const {
    if (names_.size() > 1) return;
    for (const auto& [sign, called] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}}) {
      if (text_.find(sign) != std::string_view::npos)
        refuse_body(std::string("line 1: the columns are separated by ") + called +
                    "; separate them by commas, and write numbers with a decimal point");
    }
  }

  void read_samples() {
    if (trimmed_cell(text_).empty() && rest_.find_first_not_of("\r\n") == std::string_view::npos) return;
    if (!split_line(text_, cells_)) return add_line_fault("a quotation mark is not closed");
    if (cells_.size() != names_.size()) return add_count_fault();
    read_cells();
    check_value_count(run_.time_s.size() * (choice_.columns.size() + 1));
    if (faults_.size() >= kMostFileFaults) throw_if_any(std::move(faults_));
  }

  void read_cells() {
    const std::size_t faults_before = faults_.size();
    const double time = read_cell(choice_.time);
    for (std::size_t c = 0; c < choice_.columns.size(); ++c)
      run_.columns[c].push_back(read_cell(choice_.columns[c]));
    if (line_ == 2 && faults_.size() - faults_before == choice_.columns.size() + 1) refuse_units();
    // A time that cannot be read takes no part in the check that times increase.
    if (faults_.size() == faults_before) {
      run_.time_s.push_back(time);
      lines_.push_back(line_);
    }
  }

  double read_cell(std::size_t column) {
    const std::string_view cell = trimmed_cell(cells_[column]);
    const auto number = find_number(cell);
    if (number && std::isfinite(*number)) return *number;
    faults_.push_back({"", place(line_, column) + ": " + describe_cell(cell)});
    return 0.0;
  }

  void add_line_fault(const std::string& detail) {
    faults_.push_back({"", "line " + std::to_string(line_) + ": " + detail});
    if (faults_.size() >= kMostFileFaults) throw_if_any(std::move(faults_));
  }

  void add_count_fault() {
    std::string detail = "has " + std::to_string(cells_.size()) + (cells_.size() == 1 ? " cell" : " cells") +
                         ", but line 1 names " + std::to_string(names_.size()) + " columns";
    if (trimmed_cell(text_).empty()) detail = "is empty";
    else if (cells_.size() == 2 * names_.size())
      detail += "; write numbers with a decimal point, not a comma";
    faults_.push_back({"", "line " + std::to_string(line_) + " " + detail});
    if (faults_.size() >= kMostFileFaults) throw_if_any(std::move(faults_));
  }

  [[noreturn]] static void refuse_units() {
    refuse_body(
        "line 2 holds no numbers; a line of units is not read: the name of a channel ends in its unit");
  }

  std::string_view rest_;
  const ColumnQuery& query_;
  std::string_view text_;  ///< of the line
  std::size_t line_ = 0;   ///< its number, from 1
  std::vector<std::string> names_, cells_;
  ColumnChoice choice_;
  MeasuredRun run_;
  std::vector<std::size_t> lines_;  ///< of each sample
  std::vector<Fault> faults_;
};

}  // namespace

Measurement read_measurement_csv(std::string_view text, const ColumnQuery& query) {
  return CsvReader(text, query).read();
}

}  // namespace jobs
