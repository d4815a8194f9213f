// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/analysis/run_result.h"
#include "engine/model/linkage.h"

namespace engine {

/// The channels of a run of this linkage, and its metrics in the order of RunResult::metrics.
struct LinkageTables {
  std::vector<QuantityInfo> channels, metrics;
};
[[nodiscard]] LinkageTables linkage_tables(const Linkage& linkage);

/// Refuses a linkage that cannot be simulated: an inertia no body can have, freedoms that move nothing that
/// weighs, loops that do not close at t = 0 or do not let the drives begin, a spring without a direction
/// then. Bodies and joints must fit together as build_linkage() asks, and beams, springs and clearances be
/// within the bounds that their structures name: neither is looked at.
/// @param integrator  kRk4 integrates even where the drives determine the motion: every freedom needs mass
///     then
/// @returns it built, the springs of no given free length unloaded in the assembled position
/// @throws InvalidInput for the first fault; its field is "bodies.NAME.mass" and the like, "joints.NAME" for
/// a loop or a freedom, "joints" for several of them together, "springs.NAME".
BuiltLinkage check_linkage(const Linkage& linkage, Integrator integrator = Integrator::kAuto);

/// Freedoms that neither drives nor joints take from a linkage in its assembled position. Bending is none.
/// @throws InvalidInput as check_linkage does.
[[nodiscard]] int count_undriven_freedoms(const Linkage& linkage);

/// Simulates a described linkage from its assembled position.
/// The same linkage gives the same bytes, whatever else the process does.
/// @param options  all above 0
/// @param steady_from  where the steady window of the metrics begins, [s]
/// @throws InvalidInput as check_linkage does.
[[nodiscard]] RunResult simulate_linkage(const Linkage& linkage, const RunOptions& options,
                                         double steady_from, const StopQuery& stop_requested);

}  // namespace engine
