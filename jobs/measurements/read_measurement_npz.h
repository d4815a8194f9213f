// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "jobs/measurements/column_choice.h"
#include "jobs/measurements/measurement.h"

namespace jobs {

/// Measurement of one run from NumPy's NPZ: one array a column, as numpy.savez and savez_compressed write it.
/// @throws InvalidRequest with the faults, each with the name of its array
[[nodiscard]] Measurement read_measurement_npz(std::string_view archive, const ColumnQuery& query);

}  // namespace jobs
