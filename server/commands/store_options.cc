// SPDX-License-Identifier: Apache-2.0
#include "server/commands/store_options.h"

#include <CLI/CLI.hpp>

namespace server::commands {

CLI::Option* add_store_option(CLI::App& command, std::string& store, const std::string& help) {
  return command.add_option("--db", store, help)
      ->check(describe_store_name_fault)
      ->type_name("FILE")
      ->envname("RPSUP_DB");
}

void add_threads_option(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Jobs computed at a time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str()
      ->envname("RPSUP_THREADS");
}

std::string describe_store_name_fault(const std::string& name) {
  if (name.empty()) return "the store has no name: a file is needed";
  if (name == ":memory:") return ":memory: would keep nothing: a store is a file (./:memory: is one)";
  if (name.starts_with("file:"))
    return "file: URIs are not taken: give the path alone (./" + name + " is a file)";
  return "";
}

}  // namespace server::commands
