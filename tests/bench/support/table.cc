// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/support/table.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <ostream>

namespace bench {

namespace {

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(width - std::min(width, text.size()), ' ');
  return left ? text + blanks : blanks + text;
}

}  // namespace

std::string digits(double value, int significant) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", significant, value);
  return text;
}

void Table::print(std::ostream& out) const {
  std::vector<std::size_t> widths(rows_.front().size(), 3);
  for (const auto& row : rows_)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    for (std::size_t i = 0; i < widths.size(); ++i)
      out << "| " << padded(i < rows_[r].size() ? rows_[r][i] : "", widths[i], i == 0) << ' ';
    out << "|\n";
    if (r > 0) continue;
    for (std::size_t i = 0; i < widths.size(); ++i)
      out << '|' << std::string(widths[i] + 1, '-') << (i == 0 ? '-' : ':');
    out << "|\n";
  }
  out << std::flush;
}

}  // namespace bench
