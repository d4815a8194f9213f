// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "jobs/service.h"
#include "server/commands/remote_service.h"
#include "server/messages/formats.h"

namespace server::commands {

struct SweepOptions {
  std::string file;           ///< request of a sweep or of a study; "-": standard input
  std::string store;          ///< SQLite file; empty: a running service computes
  RemoteOptions remote;       ///< that service
  std::string results = "-";  ///< file of the table of results; "-": standard output
  std::string format;         ///< of the table; empty: that of the file's suffix
  int threads = 2;            ///< with a store
};

/// Service on the store of a command, which tells what needs a human's eye on standard error.
[[nodiscard]] jobs::ServiceOptions service_options_of(const SweepOptions& options);
/// Format of the table of results, whose file can be written. @throws BadInput, CannotWrite
[[nodiscard]] TableFormat check_results(const SweepOptions& options);

/// Runs a sweep on a store and writes its table. @returns its resource; empty: the user ended it first
[[nodiscard]] std::optional<nlohmann::json> sweep_in_store(const nlohmann::ordered_json& request,
                                                           const SweepOptions& options);

}  // namespace server::commands
