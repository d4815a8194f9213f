// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace server::commands {

struct SimulateOptions {
  std::string file;                   ///< parameter object; "-": standard input
  std::string trajectory;             ///< file of the trajectory; empty: none
  std::string format;                 ///< of the trajectory; empty: that of the file's suffix
  std::vector<std::string> channels;  ///< of the trajectory; empty: all
  std::string
      plot;  ///< .svg file for a picture of the slider's acceleration; "-": standard error; empty: none
};

/// Computes one job on the spot and prints it as GET /v1/jobs/{id} would.
/// @returns an exit code
int simulate(const SimulateOptions& options);

}  // namespace server::commands
