// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"

namespace jobs {

/// Rows of a table that agree in some columns, in their order.
struct RowGroup {
  std::vector<nlohmann::json> values;  ///< of those columns
  std::vector<std::size_t> rows;
};

/// Index of a column. @throws InvalidRequest with that pointer if there is none of that name
[[nodiscard]] std::size_t find_column(const ResultTable& table, const std::string& name,
                                      const std::string& pointer);

/// In the order of their first rows.
[[nodiscard]] std::vector<RowGroup> group_rows(const ResultTable& table,
                                               const std::vector<std::size_t>& columns);

/// A metric of the table's linkages. @param wanted its name; empty: the peak of the slider's acceleration, or
/// the first one if there is none
/// @throws InvalidRequest with the pointer "/metric", and the names that there are, if there is no such
///     metric
[[nodiscard]] std::string choose_metric(const ResultTable& table, const std::string& wanted);

/// The same; if no name is wanted, of other linkages the first acceleration whose values differ and that no
/// drive prescribes, else the first such metric that is no peak's time, else the first one.
[[nodiscard]] std::string choose_free_metric(const nlohmann::json& sweep, const ResultTable& table,
                                             const std::string& wanted);

/// Wanted metrics that the table's linkages have; if they lack the first of them, their own first ones but
/// times of peaks, as many at most.
[[nodiscard]] std::vector<std::string> choose_metrics(const ResultTable& table,
                                                      std::span<const std::string_view> wanted);

/// The metric's column. @throws InvalidRequest with the pointer "/metric" if there is no such metric
[[nodiscard]] std::size_t find_metric(const ResultTable& table, const std::string& metric);

/// The number in a cell, if there is one.
[[nodiscard]] std::optional<double> number_in(const nlohmann::json& cell);

}  // namespace jobs
