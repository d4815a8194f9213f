// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"
#include "jobs/measurements/measurement.h"

namespace jobs {

/// Query that comes with a file of columns.
struct ColumnQuery {
  std::string name{};                   ///< of the measurement
  std::string time{};                   ///< column of the time; empty: time_s, t_s, or the first one
  std::vector<std::string> channels{};  ///< COLUMN:CHANNEL, or COLUMN for one that has the channel's name
  nlohmann::ordered_json sensors = nlohmann::ordered_json::object();     ///< kSensorKeys by channel
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();  ///< of MeasuredRun
};

/// Columns of a file that are read.
struct ColumnChoice {
  std::size_t time = 0;              ///< index of the column
  std::vector<std::size_t> columns;  ///< index of the column of each channel
  std::vector<MeasuredChannel> channels;
  nlohmann::json parameters = nlohmann::json::object();  ///< of MeasuredRun
};

/// Chooses the columns of the time and of the channels.
/// @param place  where a column stands in the file, for the faults: "line 1, column 3 (acc)"
/// @throws InvalidRequest with every fault of the query, of the names and of the channels
[[nodiscard]] ColumnChoice choose_columns(std::span<const std::string> names, const ColumnQuery& query,
                                          const std::function<std::string(std::size_t)>& place);

}  // namespace jobs
