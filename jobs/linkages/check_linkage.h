// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/rpsup_parameters.h"
#include "jobs/base/errors.h"

namespace jobs {

/// Names of the joints of a described linkage, each behind the one that carries its first body, those that
/// close loops last. Empty if the description has faults, which are added to `faults`.
[[nodiscard]] std::optional<std::vector<std::string>> check_linkage_json(
    const nlohmann::json& description, const engine::RpsupParameters& defaults, std::vector<Fault>& faults);

}  // namespace jobs
