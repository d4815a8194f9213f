// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/commands/cluster_options.h"

namespace server::commands {

struct ServeOptions {
  std::string store;               ///< SQLite file
  std::string host =
      "127.0.0.1";  ///< an address of this machine; others than those of the loopback need a token
  int port = 8080;                 ///< 0: any free one
  int threads = 2;
  std::vector<std::string> cors_origins;  ///< other sites whose pages may ask
  std::vector<std::string> names;         ///< other names under which clients reach the service
  std::string base_path;                  ///< path under which a proxy shows the service
  std::string token_file;  ///< with the token that clients must carry; empty: that of the environment, if
                           ///< there is one
  double job_time_s = 3600.0;             ///< most that a job may take; 0: no limit, as below
  long job_steps = 100'000'000;
  std::optional<long> job_memory_mb;      ///< empty: as much as the memory limit leaves, at most 1024
  long store_limit_mb = 0;
  long disk_reserve_mb = 100;
  std::string executor = "local";         ///< of sweeps that name none
  ClusterOptions cluster;
  std::string log_level = "info";
};

/// Runs the service until SIGTERM or SIGINT.
/// @returns an exit code
int serve(const ServeOptions& options);

}  // namespace server::commands
