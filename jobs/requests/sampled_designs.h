// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/parameters/range.h"
#include "jobs/requests/design_kinds.h"
#include "jobs/statistics/unit_points.h"

namespace jobs {

// Designs that fill a space: {"type", "count", "seed", "over": {path: {"from", "to", "scale"} or a list}}. A
// coordinate u in [0, 1) is
//
//     of a number:    from (1 - u) + to u,                  or with "log"  from (to / from)^u,
//     of an integer:  from + floor(u (to - from + 1)),      or with "log"  floor(from ((to + 1) / from)^u),
//     of a list:      its value with the number floor(u n),
//
// so that every integer from `from` to `to` and every value of a list has its share of the points.

[[nodiscard]] std::uint64_t count_samples(const nlohmann::ordered_json& design,
                                          const nlohmann::json& parameters, std::vector<Fault>& faults);

/// The seed is 1 if there is none.
[[nodiscard]] DesignPoints make_latin_hypercube(const nlohmann::ordered_json& design,
                                                const nlohmann::json& parameters, std::vector<Fault>& faults);

/// Without a seed the sequence as it is, from the corner where every parameter is at `from`.
[[nodiscard]] DesignPoints make_sobol(const nlohmann::ordered_json& design, const nlohmann::json& parameters,
                                      std::vector<Fault>& faults);

// Designs that a sensitivity is calculated from (jobs/statistics/effect_points.h), over the same ranges and
// lists.

inline constexpr std::uint64_t kDefaultLevels = 4;
/// Trajectories of morris, count of saltelli
inline constexpr Range kBlocksRange{.minimum = 2, .maximum = 1e6};
inline constexpr Range kLevelsRange{.minimum = 2, .maximum = 1000};  ///< even ones

[[nodiscard]] std::uint64_t count_morris(const nlohmann::ordered_json& design,
                                         const nlohmann::json& parameters, std::vector<Fault>& faults);
[[nodiscard]] DesignPoints make_morris(const nlohmann::ordered_json& design, const nlohmann::json& parameters,
                                       std::vector<Fault>& faults);
[[nodiscard]] std::uint64_t count_saltelli(const nlohmann::ordered_json& design,
                                           const nlohmann::json& parameters, std::vector<Fault>& faults);
[[nodiscard]] DesignPoints make_saltelli(const nlohmann::ordered_json& design,
                                         const nlohmann::json& parameters, std::vector<Fault>& faults);

/// The points of the unit cube that a design of these two kinds stretches. @param design without faults, of
/// type "morris" or "saltelli"
[[nodiscard]] UnitPoints effect_points_of(const nlohmann::ordered_json& design);

/// The same where values of lists and whole numbers are: at 0 the first, at 1 the last, others between.
[[nodiscard]] UnitPoints effect_positions_of(const nlohmann::ordered_json& design);

}  // namespace jobs
