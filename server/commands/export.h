// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace server::commands {

struct ExportOptions {
  std::string store;  ///< SQLite file
  std::string file;   ///< where the copy goes; must not exist
};

/// Writes a consistent copy of a store, which may be in use by a running service. The copy is a store itself,
/// in one file.
/// @returns an exit code
int export_store(const ExportOptions& options);

}  // namespace server::commands
