#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/errors.h"

namespace jobs {

/// One swept parameter and its values, in the order of the request.
struct Axis {
  std::string path;                     ///< "clearance_mm", "links.1,3.mass_kg"
  std::vector<nlohmann::json> values;
  std::vector<std::string> pointers;    ///< where each value stands in the request
};

/// How many values an axis has, without making them. 0 if it has faults, which are added.
/// @param pointer  where the axis stands in the request
[[nodiscard]] std::uint64_t count_axis_values(const std::string& path, const nlohmann::json& axis, const std::string& pointer,
                                              std::vector<Fault>& faults);

/// The values of an axis whose count is known to be affordable. Faults of single values are added.
///
///     linear:  (from (n - 1 - k) + to k) / (n - 1),    log:  from (to / from)^(k / (n - 1)),    both with exact ends.
[[nodiscard]] Axis make_axis(const std::string& path, const nlohmann::json& axis, const std::string& pointer, std::vector<Fault>& faults);

/// A value of an axis in the form in which equal values are equal: 5 and 5.0 are one number. @param value  one without faults
[[nodiscard]] std::string value_identity(const std::string& path, const nlohmann::json& value);

}  // namespace jobs
