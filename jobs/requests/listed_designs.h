// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/requests/design_kinds.h"

namespace jobs {

// Designs of lists: {"type", "over": {path: an axis}}, where an axis is what it is in "sweep".

/// All axes have the same number of values.
[[nodiscard]] std::uint64_t count_zip(const nlohmann::ordered_json& design, const nlohmann::json& parameters,
                                      std::vector<Fault>& faults);
[[nodiscard]] DesignPoints make_zip(const nlohmann::ordered_json& design, const nlohmann::json& parameters,
                                    std::vector<Fault>& faults);

/// "centre" has values of parameters in "over"; those that it leaves out have their defaults. An axis may
/// contain the centre's value: the centre is one point all the same.
[[nodiscard]] std::uint64_t count_one_at_a_time(const nlohmann::ordered_json& design,
                                                const nlohmann::json& parameters, std::vector<Fault>& faults);
[[nodiscard]] DesignPoints make_one_at_a_time(const nlohmann::ordered_json& design,
                                              const nlohmann::json& parameters, std::vector<Fault>& faults);

}  // namespace jobs
