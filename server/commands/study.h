// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/commands/remote_kinds.h"
#include "server/commands/sweep.h"

namespace server::commands {

/// Computes a sweep or a study: with a store in this process, else by a running service. Writes its table,
/// and the answer of a study to standard error. Interrupted, a command with a store can be given again: what
/// was computed is in the store; a service goes on. A measurement of a fit's request may have "file", the
/// name of a file beside that of the request, and "columns", COLUMN:CHANNEL, in the place of "id".
/// @returns an exit code
int compute(Kind kind, const SweepOptions& options);

}  // namespace server::commands
