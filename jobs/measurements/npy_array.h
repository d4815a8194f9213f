// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace jobs {

/// Numbers of a .npy file (NumPy's format 1.0 to 3.0): float64 or float32, little-endian, of one dimension.
/// @param name  of the array, for the faults
/// @throws InvalidRequest for any other file
[[nodiscard]] std::vector<double> read_npy(std::string_view file, const std::string& name);

}  // namespace jobs
