// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/links.h"
#include "engine/model/rpsup_parameters.h"
#include "jobs/base/errors.h"
#include "jobs/parameters/range.h"

namespace jobs {

/// The names of the links, in the order of engine::RpsupParameters::links.
inline constexpr std::array<std::string_view, engine::kLinkCount> kLinkNames{"1,1", "1,2", "1,3", "2,1",
                                                                             "2,2"};
inline constexpr std::string_view kMassKey = "mass_kg";
inline constexpr std::string_view kInertiaKey = "inertia_kg_m2";
inline constexpr Range kMassRange{.minimum = 0.0, .maximum = 1e6, .lower = Bound::kExclusive};
inline constexpr Range kInertiaRange{.minimum = 0.0, .maximum = 1e9, .lower = Bound::kExclusive};

/// The faults of the parts that `given`, a value of the key `links`, has; each by itself. Pointers start at
/// the parameter set.
[[nodiscard]] std::vector<Fault> find_link_faults(const nlohmann::json& given);

/// All parts of all links: the given ones, and for the others the defaults, which follow what else is given:
///
///     m = m_0 (l / l_0) (d^2 - d_i^2) / (d_0^2 - d_i0^2),
///     I_x = I_x0 (m / m_0) (d^2 + d_i^2) / (d_0^2 + d_i0^2),   I_y = I_z = m l^2 / 3 + I_x / 2
///     (engine::beam_inertia),
///
/// with outer and inner diameters d and d_i, the coupler's d_i = 0; of link (2,2) with a length, which lies
/// along z, I_z stands for I_x. Link (2,1), and (2,2) without a length, are no rods: their moments go with
/// their mass. With every length and diameter at its default and no mass given these are the engine's
/// defaults to the last bit.
/// @param given  has no faults; an object, empty if there is none
/// @param completed  the other parameters, all of them
[[nodiscard]] nlohmann::json complete_links(const nlohmann::json& given, const nlohmann::json& completed);

/// The faults of inertias that no body can have: each moment is at most the sum of the other two, about the
/// origin of the link's frame and, for the rods, about the centre of mass in their middle.
/// @param completed  all parameters
[[nodiscard]] std::vector<Fault> find_inertia_faults(const nlohmann::json& completed);

/// Writes completed links into the engine's parameters.
void write_links(const nlohmann::json& links, engine::RpsupParameters& parameters);

}  // namespace jobs
