// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/base/errors.h"

namespace jobs {

/// Splits a list of names at its commas. A name that is known may have commas itself ("links.1,3.mass_kg").
[[nodiscard]] std::vector<std::string> split_names(std::string_view text, std::span<const std::string> known);

/// Index of each name of a list among the known ones. Names that are not there, empty ones and repeated ones
/// are faults.
/// @param listed  where to read the known ones if they are many; empty: nowhere else
/// @param pointer  of the list in the request, for the faults
[[nodiscard]] std::vector<std::size_t> find_names(const std::vector<std::string>& names,
                                                  std::span<const std::string> known, std::string_view listed,
                                                  const std::string& pointer, std::vector<Fault>& faults);

}  // namespace jobs
