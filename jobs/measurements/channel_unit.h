// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace jobs {

/// Unit of a channel or metric, from the end of its name: "m/s²" of "slider_acceleration_m_s2". Empty if the
/// name ends in no known unit.
[[nodiscard]] std::optional<std::string_view> find_unit(std::string_view name);

}  // namespace jobs
