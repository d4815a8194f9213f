// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "jobs/service.h"
#include "server/routes/tables.h"

namespace server::commands {

struct SweepOptions {
  std::string file;           ///< request of a sweep or of a study; "-": standard input
  std::string store;          ///< SQLite file
  std::string results = "-";  ///< where the table of results goes, as CSV; "-": standard output
  int threads = 2;
};

/// Service on the store of a command, which tells what needs a human's eye on standard error.
[[nodiscard]] jobs::ServiceOptions service_options_of(const SweepOptions& options);
/// Format that a file's name ends in; CSV for all others.
[[nodiscard]] TableFormat format_of_file(const std::string& path);

/// Runs a sweep without a server. Interrupted, it can be given again: what was computed is in the store.
/// @returns an exit code
int sweep(const SweepOptions& options);

}  // namespace server::commands
