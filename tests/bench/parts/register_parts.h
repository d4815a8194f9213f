// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace bench {

/// The right-hand side and the contact law alone.
void register_evaluations();

/// Steps of each integrator, and whole jobs.
void register_runs();

/// Trajectories to bytes and back.
void register_codec();

}  // namespace bench
