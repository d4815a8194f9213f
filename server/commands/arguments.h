// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace server::commands {

/// Words of the command line as the parser understands them: options of a command that stand before the
/// command come behind its words, and --plot has a value only if the name of a picture follows.
/// @param app  the program with all of its commands
/// @throws BadInput for a command that does not exist
[[nodiscard]] std::vector<std::string> arrange_arguments(const CLI::App& app, std::vector<std::string> words);

/// "there is no option --ulr of status; did you mean --url?"
/// @param app   that has parsed a command
/// @param word  the option, perhaps with its value
[[nodiscard]] std::string describe_unknown_option(const CLI::App& app, const std::string& word);

/// Refuses a variable of the environment that its option does not take: CLI11 passes over it from 2.4 on.
/// @param app  that has parsed a command
/// @throws BadInput
void check_environment(CLI::App& app);

/// @returns whether an option stands on the command line, with or without its value in the same word
[[nodiscard]] bool is_given(const std::vector<std::string>& words, const std::string& option);

}  // namespace server::commands
