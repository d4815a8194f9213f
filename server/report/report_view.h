// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"

namespace server::report {

enum class Appendix { kNone, kRows };

/// Choices of a reader of a report.
struct ReportQuery {
  std::string metric{};  ///< empty: see jobs::choose_free_metric()
  std::string x{};       ///< axis along the charts; empty: the first with different numbers
  Appendix appendix = Appendix::kNone;
};

/// A sweep and its results, as the parts of a report look at them.
struct ReportView {
  /// @throws jobs::InvalidRequest ("/metric", "/x")
  ReportView(const nlohmann::json& sweep, const jobs::ResultTable& results, const ReportQuery& query);

  [[nodiscard]] std::size_t column(const std::string& name) const;
  /// "crank velocity 15 rad/s, coupler rigid"
  [[nodiscard]] std::string setting_of(const std::vector<nlohmann::json>& row) const;

  const nlohmann::json& sweep;
  const jobs::ResultTable& results;
  std::string metric;
  std::size_t metric_column;
  std::vector<std::string> axes;     ///< paths of what differs from job to job
  std::optional<std::string> along;  ///< axis of numbers; empty: none is varied
  bool designed = false;             ///< points of a design lie beside each other
};

/// Mean of a metric over rows; empty if none has it.
[[nodiscard]] std::optional<double> mean_of(const jobs::ResultTable& results,
                                            const std::vector<std::size_t>& rows, std::size_t column);

}  // namespace server::report
