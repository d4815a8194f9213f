// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/integrate/observer.h"
#include "engine/integrate/run_outcome.h"
#include "engine/model/mechanism.h"
#include "engine/model/run_options.h"

namespace engine {

/// Runs a mechanism from its assembled position, at rest but for what the drives ask at t = 0.
///
/// A mechanism whose drives alone decide its motion is solved at each instant, not integrated, unless the
/// paper's fixed-step method (or drives with multipliers) is asked for.
[[nodiscard]] RunOutcome simulate(const Mechanism& mechanism, const RunOptions& options, Observer& observer);

}  // namespace engine
