// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"
#include "jobs/parameters/span.h"
#include "jobs/requests/sweep_request.h"

namespace jobs {

/// Parameter that a study varies within a span.
struct Variable {
  std::string path;
  Span span;
  bool integer = false;
  std::optional<double> start{};  ///< value of one of the first points
};

/// Reads {"from", "to", "scale", "start"}, the entry of a parameter in "over".
/// @param path     of any numeric parameter, or of a number of a description
/// @param given    the entry
/// @param pointer  where it stands, for the faults, which are added
/// @param request  of the study: "parameters" and axes must not have the path, too
/// @param common   what has been read of it
[[nodiscard]] std::optional<Variable> read_variable(const std::string& path, const nlohmann::json& given,
                                                    const std::string& pointer,
                                                    const nlohmann::ordered_json& request,
                                                    const SweepRequest& common, std::vector<Fault>& faults);

}  // namespace jobs
