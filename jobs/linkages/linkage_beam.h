// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/flexible/rfem.h"
#include "engine/model/rpsup_parameters.h"
#include "jobs/base/errors.h"

namespace jobs {

/// The faults that the keys of a beam have together. @param beam  its keys have no faults each by itself
void check_beam(const nlohmann::json& beam, const engine::RpsupParameters& defaults,
                const std::string& pointer, std::vector<Fault>& faults);

/// @param beam  without faults  @param mass  [kg]
[[nodiscard]] engine::UniformBeam read_beam(const nlohmann::json& beam, double mass,
                                            const engine::RpsupParameters& defaults);

}  // namespace jobs
