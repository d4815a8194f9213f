// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/linkage.h"
#include "engine/model/rpsup_parameters.h"

namespace jobs {

/// @param description  without faults  @param order  names of the joints, of check_linkage_json()
[[nodiscard]] engine::Linkage make_linkage(const nlohmann::json& description,
                                           const engine::RpsupParameters& defaults,
                                           const std::vector<std::string>& order);

}  // namespace jobs
