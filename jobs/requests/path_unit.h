// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace jobs {

/// Unit of the values of a parameter or of another path, "N/m" of "linkage.springs.stay.stiffness_n_m".
/// @returns empty text: it has none; nothing: the name is no path
[[nodiscard]] std::optional<std::string> find_path_unit(std::string_view name);

}  // namespace jobs
