// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/parameters/parameter_table.h"

namespace jobs {

/// Fault of a value by itself, and what is allowed; empty if it may be used.
[[nodiscard]] std::string describe_fault(const ParameterInfo& info, const nlohmann::json& value);

/// The same for any number. Booleans are no numbers.
[[nodiscard]] std::string describe_number_fault(const Range& range, std::string_view unit,
                                                const nlohmann::json& value);

/// The same for any integer: 4.0 is one, 4.5 and true are not.
[[nodiscard]] std::string describe_integer_fault(const Range& range, const nlohmann::json& value);

/// A value that may be used, in the one form in which it is stored: numbers as doubles, -0 as 0, integers as
/// integers.
[[nodiscard]] nlohmann::json canonical_value(const ParameterInfo& info, const nlohmann::json& value);

/// A number of a parameter set, which has it, by its key.
[[nodiscard]] inline double number_at(const nlohmann::json& parameters, std::string_view key) {
  return parameters.at(key).get<double>();
}

/// Text for a key that is none of `known`: "unknown key; did you mean clearance_mm?", else all of them.
/// @param listed  where to read them if they are many; empty: nowhere else
[[nodiscard]] std::string describe_unknown_key(std::string_view key, std::span<const std::string_view> known,
                                               std::string_view listed = {});

/// A key as a part of an RFC 6901 pointer, with its leading slash.
[[nodiscard]] std::string pointer_token(std::string_view key);

}  // namespace jobs
