// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/channel_unit.h"

#include <algorithm>
#include <array>
#include <utility>

namespace jobs {
namespace {

/// Ends of names and their units; the first that fits counts.
constexpr std::array<std::pair<std::string_view, std::string_view>, 17> kUnits{{{"_j_m", "J m"},
                                                                                {"_rad_s2", "rad/s²"},
                                                                                {"_rad_s", "rad/s"},
                                                                                {"_m_s2", "m/s²"},
                                                                                {"_m_s", "m/s"},
                                                                                {"_n_m", "N m"},
                                                                                {"_mrad", "mrad"},
                                                                                {"_rad", "rad"},
                                                                                {"_mm", "mm"},
                                                                                {"_um", "µm"},
                                                                                {"_n", "N"},
                                                                                {"_a", "A"},
                                                                                {"_v", "V"},
                                                                                {"_w", "W"},
                                                                                {"_j", "J"},
                                                                                {"_s", "s"},
                                                                                {"_m", "m"}}};

}  // namespace

std::optional<std::string_view> find_unit(std::string_view name) {
  const auto found =
      std::ranges::find_if(kUnits, [&](const auto& unit) { return name.ends_with(unit.first); });
  return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace jobs
