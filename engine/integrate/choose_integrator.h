// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "engine/integrate/radau.h"
#include "engine/model/mechanism.h"
#include "engine/model/run_options.h"

namespace engine {

/// @returns whether any joint of the mechanism has clearance
[[nodiscard]] bool has_clearance(const Mechanism& mechanism);

/// @returns whether dry friction acts in any joint without clearance
[[nodiscard]] bool has_joint_friction(const Mechanism& mechanism);

/// @returns whether joints are ideal and there are no springs and dampers: nothing that would be stiff
[[nodiscard]] bool is_rigid(const Mechanism& mechanism);

/// The integrator that is used: the requested one; for kAuto radau5. With radau5 at the tolerance of
/// choose_tolerance() nearly all converging peaks are right to 0.1 %; no other method was as right for
/// clearly less work. Exception: friction without bristles between rigid links asks for tolerances at which
/// dopri5 takes half the time.
[[nodiscard]] Integrator choose_integrator(const Mechanism& mechanism, Integrator requested);

/// Settings of radau5 for the mechanism. An impact sets off the next ones: with clearance an error counts
/// more. Little damps the journal on its bore: an error that the iterations leave excites it, above all
/// without the friction of slow bristles.
[[nodiscard]] Radau5Settings choose_radau5_settings(const Mechanism& mechanism);

/// Longest step of an error-controlled integrator, [s]. With radau5 and clearance it is shorter where
/// friction is quick, and where links are elastic: there friction excites vibrations that longer steps would
/// damp.
/// @param integrator  not kAuto
[[nodiscard]] double choose_longest_step(const Mechanism& mechanism, Integrator integrator);

/// Time between two checks of local stability (UnstableModeLimiter), [s]: vibrations that grow and end
/// between two checks are not seen. Infinite if steps damp none or there is no friction to excite any.
/// @param integrator  not kAuto
[[nodiscard]] double choose_stability_check_interval(const Mechanism& mechanism, Integrator integrator,
                                                     Eigen::Index free_coordinates);

/// Tolerance of kAuto, of the steps' errors and of the energy account: the requested tolerance over a
/// divisor, so that peaks are about equally right in all mechanisms. The divisor is larger in worn bores,
/// and where friction is not that of slow bristles; smaller with contact elements, where one that begins to
/// touch changes little. With friction without bristles the tolerance is at most 1e-9. Table: README.md.
[[nodiscard]] double choose_tolerance(const Mechanism& mechanism, double requested);

}  // namespace engine
