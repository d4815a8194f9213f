// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "validation/findings.h"

namespace validation {

[[nodiscard]] Findings compute_residual_orders();
[[nodiscard]] Findings compute_onset_orders();
[[nodiscard]] Findings compute_causes_of_loss();
[[nodiscard]] Findings compute_closed_form_losses();
[[nodiscard]] Findings compute_sampled_losses();
[[nodiscard]] Findings compute_whole_account();

}  // namespace validation
