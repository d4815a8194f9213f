// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"

namespace jobs {

/// Points of the space of some parameters that are not all combinations of lists.
struct Design {
  std::vector<std::string> paths;                   ///< the parameters, in the order of the request
  std::vector<std::vector<nlohmann::json>> points;  ///< one value a parameter each; empty: there is no design
};

/// Number of points of {"type", "over", ...}, without making them. 0 if it has faults, which are added; they
/// point into "/design".
/// @param parameters  of all points of the sweep, without faults: the centre of one_at_a_time is made of them
[[nodiscard]] std::uint64_t count_design_points(const nlohmann::ordered_json& design,
                                                const nlohmann::json& parameters, std::vector<Fault>& faults);

/// The points of a design that has no faults so far and whose count is known to be affordable. Faults of
/// single values are added.
///
///     latin_hypercube, sobol:  points of the unit cube (jobs/statistics/unit_points.h), stretched over
///                              {"from", "to", "scale"} or over a list
///     zip:                     the k-th point has the k-th value of each list
///     one_at_a_time:           the centre, then one parameter after the other with each of its values, the
///                              others at the centre
///     morris, saltelli:        points of the unit cube (jobs/statistics/effect_points.h), stretched as those
///                              of latin_hypercube
[[nodiscard]] Design make_design(const nlohmann::ordered_json& design, const nlohmann::json& parameters,
                                 std::vector<Fault>& faults);

}  // namespace jobs
