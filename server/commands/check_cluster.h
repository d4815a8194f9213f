// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/commands/cluster_options.h"

namespace server::commands {

struct CheckClusterOptions {
  ClusterOptions cluster;
  int wait_s = 300;  ///< for the result of a node
};

/// Tries a cluster out and says in plain words what is wrong with it, and what to do.
/// @returns an exit code
int check_cluster(const CheckClusterOptions& options);

}  // namespace server::commands
