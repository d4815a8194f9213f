// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "validation/findings.h"

namespace validation {

/// A chapter with what its parts have found, in their order.
struct ComputedChapter {
  Chapter chapter;
  std::vector<Findings> findings;
};

/// How far a number of the report may lie from that of another run, on a machine that rounds otherwise.
struct Tolerance {
  double absolute = 0.0;
  double relative = 0.0;   ///< to the larger of the two
  double factor = 1.0;     ///< larger over smaller, of one sign: for residuals of rounding, and for samples
  double floor = 0.0;      ///< magnitudes below it agree

  [[nodiscard]] bool allows(double a, double b) const;
};

/// One line of the report. Without tolerances it is the same on every machine; with them they are those of its cells, in order.
struct ReportLine {
  std::string text;
  std::vector<Tolerance> cells{};
};

/// The report as Markdown.
/// @param figure_folder  where the figures are, seen from the report
[[nodiscard]] std::vector<ReportLine> write_report(const std::vector<ComputedChapter>& chapters, const std::string& figure_folder);

struct Counts {
  std::size_t checks = 0;
  std::size_t failed = 0;
};
[[nodiscard]] Counts count_checks(const std::vector<ComputedChapter>& chapters);

/// One comparison in a line of plain text: what, the difference and its bound.
[[nodiscard]] std::string describe(const Check& check);

// The report's last chapter belongs to script/faults, which plants faults and notes which test finds each; its lines stand between these.
inline constexpr const char* kFaultsBegin = "<!-- faults -->";
inline constexpr const char* kFaultsEnd = "<!-- end of faults -->";

/// A written report cut in two: what `rpsup-validate` says, and the lines about planted faults.
struct WrittenReport {
  std::vector<std::string> lines;
  std::vector<std::string> faults;
};
[[nodiscard]] WrittenReport take_faults(const std::vector<std::string>& written);

/// The text of a report's file.
[[nodiscard]] std::string to_text(const std::vector<ReportLine>& lines, const std::vector<std::string>& faults);

/// Where a written report says something else than a fresh one.
/// @param written  its lines, without those about faults
/// @returns a sentence for each line that differs by more than it may; empty: none does
[[nodiscard]] std::vector<std::string> find_differences(const std::vector<ReportLine>& fresh, const std::vector<std::string>& written);

}  // namespace validation
