// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace server::commands {

/// Adds --db. @param help  what the file is
CLI::Option* add_store_option(CLI::App& command, std::string& store, const std::string& help);

/// Adds --threads.
void add_threads_option(CLI::App& command, int& threads);

/// Fault of a store's name, for the parser: names by which SQLite keeps nothing, or takes the rest for
/// options.
[[nodiscard]] std::string describe_store_name_fault(const std::string& name);

}  // namespace server::commands
