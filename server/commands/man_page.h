// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "server/commands/option_table.h"

namespace server::commands {

/// The manual page of the program in roff, for man(1).
/// @param commands  as describe_commands() gives them
/// @param version   of the program
[[nodiscard]] std::string make_man_page(const std::vector<CommandEntry>& commands,
                                        const std::string& version);

}  // namespace server::commands
