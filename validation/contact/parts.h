// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "validation/findings.h"

namespace validation {

/// The linkage's bore has the stiffness of Hertz's contact of spheres.
[[nodiscard]] Findings compute_hertz_stiffness();
/// A mass rebounds from bore and faces with the ratio that the damping's equation gives.
[[nodiscard]] Findings compute_rebounds();
/// Without damping an impact has Hertz's depth and duration.
[[nodiscard]] Findings compute_elastic_impacts();
/// The ring of elements is a sum for an integral, with the error of such a sum.
[[nodiscard]] Findings compute_ring_of_elements();
/// A ring's elements have each the damping of their own onset, which changes the rebound.
[[nodiscard]] Findings compute_impacts_of_a_ring();
/// A ring's elements have each a bristle of their own, which changes the friction's torque.
[[nodiscard]] Findings compute_turning_journal();
/// Cause of the difference between peaks of whole runs with elements and with the closed form.
[[nodiscard]] Findings compute_whole_runs_with_elements();
/// Effect of the choice of the joint's laws on the study.
[[nodiscard]] Findings compare_laws();
/// Forces and moments on a tilted journal are those of statics, for rings and for rings of elements.
[[nodiscard]] Findings compute_tilted_journal();
/// Forces and moments on the journal's faces are those of statics.
[[nodiscard]] Findings compute_axial_faces();

}  // namespace validation
