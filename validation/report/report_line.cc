// SPDX-License-Identifier: Apache-2.0
#include "validation/report/report_line.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace validation {

namespace {

/// Numbers of a text, and the text around them.
struct Pieces {
  std::vector<double> numbers;
  std::string rest;  ///< a '#' for each number
};

bool continues_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; }

bool begins_number(const std::string& text, std::size_t at) {
  if (at > 0 && continues_word(text[at - 1])) return false;
  const std::size_t digit = text[at] == '-' ? at + 1 : at;
  return digit < text.size() && std::isdigit(static_cast<unsigned char>(text[digit]));
}

Pieces cut_numbers(const std::string& text) {
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

bool cells_agree(const std::string& fresh, const std::string& written, const Tolerance& tolerance) {
  if (fresh == written || tolerance.other_words) return true;
  const Pieces a = cut_numbers(fresh);
  const Pieces b = cut_numbers(written);
  if (a.rest != b.rest || a.numbers.size() != b.numbers.size()) return false;
  for (std::size_t k = 0; k < a.numbers.size(); ++k)
    if (!tolerance.allows(a.numbers[k], b.numbers[k])) return false;
  return true;
}

bool lines_agree(const ReportLine& fresh, const std::string& written, Split split) {
  if (fresh.text == written) return true;
  const auto a = split(fresh.text);
  const auto b = split(written);
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

std::vector<std::string> split_markdown(const std::string& line) {
  if (!line.starts_with("| ")) return {line};
  std::vector<std::string> cells;
  for (std::size_t from = 2; from < line.size();) {
    const std::size_t to = std::min(line.find(" | ", from), line.size());
    cells.push_back(line.substr(from, to - from));
    from = to + 3;
  }
  return cells;
}

std::vector<std::string> split_csv(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line[at] == '"' && quoted && at + 1 < line.size() && line[at + 1] == '"') {
      fields.back() += line[at++];
    } else if (line[at] == '"') {
      quoted = !quoted;
    } else if (line[at] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[at];
    }
  }
  return fields;
}

std::vector<std::string> find_differences(const std::vector<ReportLine>& fresh,
                                          const std::vector<std::string>& written, Split split) {
  std::vector<std::string> differences;
  for (std::size_t k = 0; k < std::max(fresh.size(), written.size()); ++k) {
    const std::string place = "line " + std::to_string(k + 1) + ": ";
    if (k >= written.size()) {
      differences.push_back(place + "missing: " + fresh[k].text);
    } else if (k >= fresh.size()) {
      differences.push_back(place + "no longer written: " + written[k]);
    } else if (!lines_agree(fresh[k], written[k], split)) {
      differences.push_back(place + "written: " + written[k] + "\n  fresh:   " + fresh[k].text);
    }
  }
  return differences;
}

std::string to_text(const std::vector<ReportLine>& lines) {
  std::string text;
  for (const ReportLine& line : lines) text += line.text + '\n';
  return text;
}

}  // namespace validation
