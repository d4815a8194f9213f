// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"
#include "jobs/parameters/range.h"

namespace jobs {

/// Largest number of values of one axis; far fewer make a sweep that is too large.
inline constexpr Range kCountRange{.minimum = 1, .maximum = 1e9};

/// One swept parameter and its values, in the order of the request.
struct Axis {
  std::string path;  ///< "clearance_mm", "links.1,3.mass_kg"
  std::vector<nlohmann::json> values;
  std::vector<std::string> pointers;  ///< place of each value in the request
};

/// Treatment of a value that stands in an axis twice.
enum class Repeats { kRefused, kAllowed };

/// @returns whether an axis may have this path; if not, the fault is added
[[nodiscard]] bool is_known_path(const std::string& path, const std::string& pointer,
                                 std::vector<Fault>& faults);

/// @returns whether a path's values are single numbers
/// @param path  a known one
[[nodiscard]] bool is_numeric(const std::string& path);

/// @returns whether a path's values are whole numbers, of a parameter or in a description
/// @param path  a known one
[[nodiscard]] bool is_integer(const std::string& path);

/// A value in the form in which equal values are equal: 5 and 5.0 are one number. @param value  has no faults
[[nodiscard]] std::string value_identity(const std::string& path, const nlohmann::json& value);

/// Number of values of an axis, without making them. 0 if it has faults, which are added.
/// @param pointer  where the axis stands in the request
[[nodiscard]] std::uint64_t count_axis_values(const std::string& path, const nlohmann::json& axis,
                                              const std::string& pointer, std::vector<Fault>& faults);

/// Pointer to a design's values of a path.
[[nodiscard]] std::string pointer_of_axis(std::string_view path);

/// @returns whether one of an axis' values is this one, without making them
/// @param axis   has passed count_axis_values
/// @param value  has no faults
[[nodiscard]] bool axis_contains(const std::string& path, const nlohmann::json& axis,
                                 const nlohmann::json& value);

/// The values of an axis whose count is known to be affordable. Faults of single values are added.
///
///     linear:  (from (n - 1 - k) + to k) / (n - 1),    log:  from (to / from)^(k / (n - 1)),
///
/// both with exact ends, and rounded between them by decimal_between().
[[nodiscard]] Axis make_axis(const std::string& path, const nlohmann::json& axis, const std::string& pointer,
                             std::vector<Fault>& faults, Repeats repeats = Repeats::kRefused);

}  // namespace jobs
