// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "jobs/cluster/site.h"

namespace jobs::cluster {

/// Finding of a check.
struct Finding {
  enum class Kind { kGood, kWarning, kFault };

  Kind kind = Kind::kGood;
  std::string text;    ///< the finding itself
  std::string advice;  ///< remedy; empty if there is none
};

/// Tries a cluster out as a service would use it, since what usually is wrong shows nowhere: asks Slurm for
/// its limits, writes into the shared folder, has sbatch look at the options, and has a node compute one job,
/// whose result must be that of this machine to the bit.
/// @param tell  told each finding at once
/// @param at_most  time for the node's result
/// @param stop_requested  asked now and then
/// @returns whether there was no fault
bool check_cluster(const Site& site, const std::function<void(const Finding&)>& tell,
                   std::chrono::seconds at_most, const std::function<bool()>& stop_requested);

}  // namespace jobs::cluster
