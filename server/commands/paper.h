// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace server::commands {

struct PaperOptions {
  std::vector<std::string> files;  ///< results of sweeps as JSON
};

/// Prints what the results of sweeps, all taken together, say to the paper's statements.
/// @returns an exit code
int hold_against_paper(const PaperOptions& options);

}  // namespace server::commands
