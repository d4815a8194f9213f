// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/commands/sweep.h"

namespace server::commands {

/// Runs an optimisation without a server: writes the table of its candidates, and its best ones to standard
/// error. Interrupted, it can be given again: what was computed is in the store.
/// @returns an exit code
int optimise(const SweepOptions& options);

/// Runs a fit in the same way: writes the table of its points, and the values of its parameters with their
/// intervals to standard error. A measurement of the request may have "file", the name of a file beside that
/// of the request, and "columns", as in `rpsup measure --channel`, in the place of "id".
/// @returns an exit code
int fit(const SweepOptions& options);

}  // namespace server::commands
