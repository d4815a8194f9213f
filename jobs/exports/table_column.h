// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "jobs/results/result_table.h"

namespace jobs {

/// Column of a table whose cells are all numbers or all texts.
struct TableColumn {
  std::string name, unit;  ///< unit: empty of texts and of what has none
  bool is_text = false;
  std::vector<double> numbers;     ///< NaN where a cell is null; true is 1
  std::vector<std::string> texts;  ///< empty where a cell is null
};

/// Columns of a table, each with numbers if no cell of it is anything else.
[[nodiscard]] std::vector<TableColumn> to_columns(const ResultTable& table);

/// Code points of a text in UTF-8.
[[nodiscard]] std::vector<char32_t> code_points_of(const std::string& text);

}  // namespace jobs
