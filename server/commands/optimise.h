// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/commands/sweep.h"

namespace server::commands {

/// Runs an optimisation without a server: writes the table of its candidates, and its best ones to standard
/// error. Interrupted, it can be given again: what was computed is in the store.
/// @returns an exit code
int optimise(const SweepOptions& options);

}  // namespace server::commands
