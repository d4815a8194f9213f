// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "validation/report/report.h"
#include "validation/report/report_line.h"

namespace validation {

/// Lines of rows.csv: the head, then every comparison and every number of the tables, in the order of the
/// chapters and their parts. The format is RFC 4180, with line feeds alone.
[[nodiscard]] std::vector<ReportLine> write_rows(const std::vector<ComputedChapter>& chapters);

}  // namespace validation
