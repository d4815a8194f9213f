// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace server::commands {

struct SweepOptions {
  std::string file;           ///< sweep request; "-": standard input
  std::string store;          ///< SQLite file
  std::string results = "-";  ///< where the table of results goes, as CSV; "-": standard output
  int threads = 2;
};

/// Runs a sweep without a server. Interrupted, it can be given again: what was computed is in the store.
/// @returns an exit code
int sweep(const SweepOptions& options);

}  // namespace server::commands
