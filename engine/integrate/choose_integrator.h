#pragma once

#include <Eigen/Core>

#include "engine/model/mechanism.h"
#include "engine/model/run_options.h"

namespace engine {

/// Whether any joint of the mechanism has clearance.
[[nodiscard]] bool has_clearance(const Mechanism& mechanism);

/// What Integrator::kAuto stands for in a mechanism; any other stays what it is.
///
/// radau5 where its long steps miss nothing: without clearance, and in bores that are not worn, with the friction of slow bristles. It damps vibrations
/// of which a step holds several periods. Bristles that follow them, or friction that jumps with the velocity, may feed them instead; there it is
/// rodas5, whose steps are shorter, and so where contacts of elements change all the time between elastic links.
[[nodiscard]] Integrator choose_integrator(const Mechanism& mechanism, Integrator wanted);

/// What a step of an error-controlled integrator is at most, [s]. It is shorter with radau5, clearance and elastic links: friction feeds vibrations of
/// these that longer steps would damp.
/// @param integrator  not kAuto
[[nodiscard]] double choose_longest_step(const Mechanism& mechanism, Integrator integrator);

/// Time between two looks for vibrations that grow (FedVibrations), [s]: what grows and ends between two is not seen. Infinite if steps damp none or
/// there is no friction to feed any.
/// @param integrator  not kAuto
[[nodiscard]] double choose_time_between_looks(const Mechanism& mechanism, Integrator integrator, Eigen::Index free_coordinates);

/// The tolerance that Integrator::kAuto takes for the one that is wanted, for the steps' errors and the energy account, so that its peaks are
/// nearly as right in one mechanism as in another. It is smaller where contacts change inside of steps all the time: those of elements, each of
/// which begins and ends for itself, those in worn bores, and those with friction of other than slow bristles.
[[nodiscard]] double choose_tolerance(const Mechanism& mechanism, double wanted);

}  // namespace engine
