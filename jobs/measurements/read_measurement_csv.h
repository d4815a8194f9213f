// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "jobs/measurements/column_choice.h"
#include "jobs/measurements/measurement.h"

namespace jobs {

/// Measurement of one run from CSV (RFC 4180): the first line names the columns, each other one holds the
/// samples of one instant, with commas between and decimal points.
/// @throws InvalidRequest with the first faults, each with its line and column
[[nodiscard]] Measurement read_measurement_csv(std::string_view text, const ColumnQuery& query);

}  // namespace jobs
