// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace server::commands {

struct ExportOptions {
  std::string store;                   ///< SQLite file
  std::string file;                    ///< destination of the copy; must not exist
  std::string sweep{};                 ///< its trajectories are written instead; empty: none
  std::string channels{};              ///< of those, with commas between; empty: all
  std::optional<double> from{}, to{};  ///< of those, [s]
  std::string format{};                ///< of those; empty: that of the suffix
};

/// Writes a consistent copy of a store, which may be in use by a running service. The copy is a store itself,
/// in one file. With a sweep the file has the trajectories of its jobs; then no service may use the store.
/// @returns an exit code
int export_store(const ExportOptions& options);

}  // namespace server::commands
