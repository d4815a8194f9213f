// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "server/commands/remote_kinds.h"

namespace server::commands {

/// Answer of a study that has ended, in lines: limits, wear, best candidates, values with their intervals.
/// Empty for a sweep, whose answer is its table.
/// @param study  as GET /v1/searches/{id}, say, shows it
[[nodiscard]] std::string answer_text(Kind kind, const nlohmann::json& study);

/// @returns whether a study has given what it was asked for
[[nodiscard]] bool has_answer(Kind kind, const nlohmann::json& study);

}  // namespace server::commands
