// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "validation/findings.h"

namespace validation {

/// Orders 4 and 5 on a pendulum, and an error that follows the tolerance.
[[nodiscard]] Findings compute_order_on_a_pendulum();
/// Orders 4 and 5 on the ideal linkage, with its constraints and drives.
[[nodiscard]] Findings compute_order_on_the_linkage();
/// Beginning and end of a contact, and the distance of the steps' ends from them.
[[nodiscard]] Findings compute_contact_instants();
/// All integrators give the same peaks of the second geometry: rigid coupler, 0.25 mm.
[[nodiscard]] Findings compute_peaks_narrow();
/// The same at 0.5 mm.
[[nodiscard]] Findings compute_peaks_wide();
/// The same with the flexible coupler, at the speed at which it converges.
[[nodiscard]] Findings compute_peaks_flexible();
/// Peaks of the study's geometry by the default.
[[nodiscard]] Findings compute_peaks_of_the_study();
/// Peaks by the default with contact elements and other friction.
[[nodiscard]] Findings compute_peaks_of_other_contacts();
/// Cost of a digit of the peak with each integrator.
[[nodiscard]] Findings compute_work_and_precision();

}  // namespace validation
