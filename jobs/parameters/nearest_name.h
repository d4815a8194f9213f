// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace jobs {

/// The name that a misspelt one was meant to be; empty if none is near. Each letter that is wrong, missing or
/// too many counts, and each two that have changed places. A name that is right but for its unit
/// ("clearance") is as near as can be.
[[nodiscard]] std::optional<std::string_view> find_nearest_name(std::string_view given,
                                                                std::span<const std::string_view> known);

}  // namespace jobs
