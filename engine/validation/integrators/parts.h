#pragma once

#include "engine/validation/findings.h"

namespace engine::validation {

[[nodiscard]] Findings compute_order_on_a_pendulum();
[[nodiscard]] Findings compute_order_on_the_linkage();
[[nodiscard]] Findings compute_contact_instants();
[[nodiscard]] Findings compute_peaks();
[[nodiscard]] Findings compute_work_and_precision();

}  // namespace engine::validation
