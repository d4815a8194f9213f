// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace server::commands {

/// Type name of an argument that is the id of a resource.
inline constexpr const char* kIdType = "ID";

/// An option or an argument of a command, as it was declared to the parser, which prints --help from the
/// same.
struct OptionEntry {
  std::string name;                  ///< "--port"; "file" for an argument
  bool argument = false;             ///< has no name on the command line
  std::string value;                 ///< type of its value, "FILE" or "INT"; empty: it takes none
  std::string allowed;               ///< "[1 - 256]"; empty: anything
  std::vector<std::string> choices;  ///< the words allowed; empty: others too
  std::string help;
  std::string default_text;          ///< empty: none
  std::string environment;           ///< variable that may give it; empty: none
  bool required = false;
  bool optional_value = false;       ///< the value may be left out
  bool many = false;                 ///< any number of values
};

struct CommandEntry {
  std::string name;
  std::string help;
  std::string footer;  ///< text behind the options, in lines
  std::vector<OptionEntry> options;
};

/// All that can be written on the command line: first the program with what goes with every command, then its
/// commands.
[[nodiscard]] std::vector<CommandEntry> describe_commands(const CLI::App& app);

/// "rpsup serve [OPTIONS]", "rpsup cancel [OPTIONS] id...".
[[nodiscard]] std::string synopsis(const std::string& program, const CommandEntry& command);

}  // namespace server::commands
