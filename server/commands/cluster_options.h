// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "jobs/cluster/site.h"

namespace CLI {
class App;
}

namespace server::commands {

/// The user's settings of the cluster, in the units of the command line.
struct ClusterOptions {
  std::string folder, program, prefix, partition, account, qos, constraint, prologue;
  std::vector<std::string> options;
  int threads = 1, slots = 64, tasks = 0;
  long memory_mb = 0;
  double task_s = 600.0, least_task_s = 60.0, poll_s = 15.0, grace_s = 60.0;
};

/// Declares them to the parser.
void add_cluster_options(CLI::App& command, ClusterOptions& options);

/// @throws BadInput
[[nodiscard]] jobs::cluster::Site make_site(const ClusterOptions& options);

}  // namespace server::commands
