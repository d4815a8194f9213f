// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "validation/findings.h"

namespace validation {

[[nodiscard]] Findings compute_stick_slip();
[[nodiscard]] Findings compute_break_away();
[[nodiscard]] Findings compute_pre_sliding();
[[nodiscard]] Findings compute_frictional_lag();
[[nodiscard]] Findings compute_sliding();
[[nodiscard]] Findings compute_fresh_bristles();
[[nodiscard]] Findings compute_dissipation();
[[nodiscard]] Findings compute_sliding_speeds();

}  // namespace validation
