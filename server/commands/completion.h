// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "server/commands/option_table.h"

namespace server::commands {

/// Scripts that teach a shell to complete commands, options, the words that an option allows, and names of
/// files.
/// @param commands  as describe_commands() gives them
[[nodiscard]] std::string make_bash_completion(const std::vector<CommandEntry>& commands);
[[nodiscard]] std::string make_zsh_completion(const std::vector<CommandEntry>& commands);
[[nodiscard]] std::string make_fish_completion(const std::vector<CommandEntry>& commands);

}  // namespace server::commands
