#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/design_kinds.h"

namespace jobs {

// Designs that fill a space: {"type", "count", "seed", "over": {path: {"from", "to", "scale"} or a list}}. A coordinate u in [0, 1) is
//
//     of a number:    from (1 - u) + to u,                  or with "log"  from (to / from)^u,
//     of an integer:  from + floor(u (to - from + 1)),      or with "log"  floor(from ((to + 1) / from)^u),
//     of a list:      its value with the number floor(u n),
//
// so that every integer from `from` to `to` and every value of a list has its share of the points.

[[nodiscard]] std::uint64_t count_samples(const nlohmann::ordered_json& design, const nlohmann::json& parameters, std::vector<Fault>& faults);

/// The seed is 1 if there is none.
[[nodiscard]] DesignPoints make_latin_hypercube(const nlohmann::ordered_json& design, const nlohmann::json& parameters, std::vector<Fault>& faults);

/// Without a seed the sequence as it is, from the corner where every parameter is at `from`.
[[nodiscard]] DesignPoints make_sobol(const nlohmann::ordered_json& design, const nlohmann::json& parameters, std::vector<Fault>& faults);

}  // namespace jobs
