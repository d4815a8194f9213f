// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

namespace jobs {

/// What JSON has for a value that may not be there.
template <typename T>
[[nodiscard]] nlohmann::json value_or_null(const std::optional<T>& value) { return value ? nlohmann::json(*value) : nlohmann::json(); }

}  // namespace jobs
