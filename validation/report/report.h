// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "validation/findings.h"
#include "validation/report/report_line.h"

namespace validation {

/// Chapter with the findings of its parts, in their order.
struct ComputedChapter {
  Chapter chapter;
  std::vector<Findings> findings;
};

struct Counts {
  std::size_t checks = 0;
  std::size_t failed = 0;
};
[[nodiscard]] Counts count_checks(const std::vector<ComputedChapter>& chapters);

/// One comparison in a line of plain text: quantity, difference and bound.
[[nodiscard]] std::string describe(const Check& check);

/// Tolerance of the numbers in a table's caption.
[[nodiscard]] Tolerance tolerance_of(const Table& table);
[[nodiscard]] Tolerance tolerance_of_row(const Table& table, std::size_t row);

/// Report as Markdown: a row for each chapter, then its introduction, with the tables and figures of
/// Place::kInReport.
/// @param figure_folder  folder of the figures, seen from the report
[[nodiscard]] std::vector<ReportLine> write_report(const std::vector<ComputedChapter>& chapters,
                                                   const std::string& figure_folder);

}  // namespace validation
