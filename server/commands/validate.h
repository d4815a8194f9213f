// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace server::commands {

/// Becomes rpsup-validate, the program beside this one.
/// @throws BadInput if there is none
[[noreturn]] void run_validate(const std::vector<std::string>& arguments);

}  // namespace server::commands
