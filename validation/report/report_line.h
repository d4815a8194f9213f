// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace validation {

/// Distance at which a number may lie from that of another run, on a machine that rounds differently.
struct Tolerance {
  double absolute = 0.0;
  double relative = 0.0;     ///< to the larger of the two
  double factor = 1.0;       ///< larger over smaller, of one sign: for residuals of rounding, and for samples
  double floor = 0.0;        ///< magnitudes below it agree
  bool other_words = false;  ///< the text may differ as well

  [[nodiscard]] bool allows(double a, double b) const;
};

/// Line of a written file. A line without tolerances is the same on every machine; tolerances belong to the
/// cells of the line, in order.
struct ReportLine {
  std::string text;
  std::vector<Tolerance> cells{};
};

/// Splits a line of a file into its cells.
using Split = std::vector<std::string> (*)(const std::string&);

/// Cells of a row of a Markdown table; other text is one cell.
[[nodiscard]] std::vector<std::string> split_markdown(const std::string& line);

/// Fields of a record of RFC 4180 that stands on one line.
[[nodiscard]] std::vector<std::string> split_csv(const std::string& line);

/// Differences between a written file and a fresh one.
/// @param split  splits lines of both
/// @returns a sentence for each line that differs by more than its tolerances; empty: no line does
[[nodiscard]] std::vector<std::string> find_differences(const std::vector<ReportLine>& fresh,
                                                        const std::vector<std::string>& written, Split split);

/// Text of a file with these lines.
[[nodiscard]] std::string to_text(const std::vector<ReportLine>& lines);

}  // namespace validation
