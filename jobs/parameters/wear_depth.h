// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/clearance/worn_bore.h"
#include "jobs/base/errors.h"
#include "jobs/parameters/range.h"

namespace jobs {

// The parameter that says how deep the bearing's bore is worn: a list for each ring of the journal, of the
// depths in sectors of equal width around it, the first from the bearing's x on. It is in a parameter set
// only if it is given.

inline constexpr std::string_view kWearKey = "wear_depth_um";
inline constexpr Range kBoreSectorsRange{.minimum = 8, .maximum = 360};
/// At most a tenth of the bearing's radius, whatever that is, [um]
inline constexpr Range kWearDepthRange{.minimum = 0.0, .maximum = 100'000.0};

/// The faults that a value has by itself, pointers from the parameter set.
[[nodiscard]] std::vector<Fault> find_wear_faults(const nlohmann::json& value);

/// A value without faults in its one form: all numbers as doubles, -0 as 0.
[[nodiscard]] nlohmann::json canonical_wear(const nlohmann::json& value);

/// The largest depth. [um]
[[nodiscard]] double deepest_wear(const nlohmann::json& value);

[[nodiscard]] engine::WearDepth to_wear_depth(const nlohmann::json& value);

[[nodiscard]] nlohmann::json wear_schema();

/// Fault of the key beside a described linkage, or in one of its joints.
inline constexpr std::string_view kWearOfDescribed =
    "worn bores are given with the linkage \"rpsup\" only; the bores of a described linkage are round";

/// Help of the key, in one line.
inline constexpr std::string_view kWearHelp =
    "Depth worn off the bearing's bore: for each ring of the journal a list of sectors of equal width, from "
    "the bearing's x on. For contact "
    "continuum";

}  // namespace jobs
