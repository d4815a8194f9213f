#pragma once

#include "engine/model/mechanism.h"
#include "engine/model/run_options.h"

namespace engine {

/// Whether any of its joints has clearance.
[[nodiscard]] bool has_clearance(const Mechanism& mechanism);

/// What Integrator::kAuto stands for in a mechanism; any other stays what it is.
///
/// radau5 where its long steps miss nothing: without clearance, and in bores that are not worn, with the friction of slow bristles. It damps vibrations
/// of which a step holds several periods. Bristles that follow them, or friction that jumps with the velocity, may feed them instead; there it is
/// rodas5, whose steps are shorter, and so where contacts of elements change all the time between elastic links. With very many coordinates it is
/// rodas5, too, which can solve body by body.
[[nodiscard]] Integrator choose_integrator(const Mechanism& mechanism, Integrator wanted);

/// What an error-controlled step of an integrator is at most, [s].
[[nodiscard]] double choose_longest_step(const Mechanism& mechanism, Integrator integrator);

/// The tolerance that Integrator::kAuto takes for the one that is wanted, for the steps' errors and the energy account, so that its peaks are
/// nearly as right in one mechanism as in another. It is smaller where contacts change inside of steps all the time: those of elements, each of
/// which begins and ends for itself, those in worn bores, and those with friction of other than slow bristles. And where it takes rodas5.
[[nodiscard]] double choose_tolerance(const Mechanism& mechanism, double wanted);

}  // namespace engine
