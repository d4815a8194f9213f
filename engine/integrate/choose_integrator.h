// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "engine/model/mechanism.h"
#include "engine/model/run_options.h"

namespace engine {

/// Whether any joint of the mechanism has clearance.
[[nodiscard]] bool has_clearance(const Mechanism& mechanism);

/// What Integrator::kAuto stands for; any other stays what it is. At the tolerance of choose_tolerance() nearly all converging peaks are right to 0.1 % with
/// radau5, whatever joints and links the mechanism has, and no other method was as right for clearly less work.
[[nodiscard]] constexpr Integrator choose_integrator(Integrator wanted) { return wanted == Integrator::kAuto ? Integrator::kRadau5 : wanted; }

/// What a step of an error-controlled integrator is at most, [s]. It is shorter with radau5 and clearance where friction is quick, and with elastic links:
/// there friction sets off or feeds vibrations that longer steps would damp.
/// @param integrator  not kAuto
[[nodiscard]] double choose_longest_step(const Mechanism& mechanism, Integrator integrator);

/// Time between two checks of local stability (UnstableModeLimiter), [s]: vibrations that grow and end between two checks are not seen.
/// Infinite if steps damp none or there is no friction to excite any.
/// @param integrator  not kAuto
[[nodiscard]] double choose_stability_check_interval(const Mechanism& mechanism, Integrator integrator, Eigen::Index free_coordinates);

/// The tolerance that Integrator::kAuto takes for the one that is wanted, for the steps' errors and the energy account, so that its peaks are
/// nearly as right in one mechanism as in another. It is smaller with clearance, the more so in worn bores and where friction is other than that of
/// slow bristles; of contact elements, one that begins to touch changes little.
[[nodiscard]] double choose_tolerance(const Mechanism& mechanism, double wanted);

}  // namespace engine
