// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "jobs/results/result_table.h"

namespace jobs {

/// The seven statements of the paper's abstract and section 3 about the largest slider acceleration, held
/// against the results of a sweep that varies clearance_mm, crank_velocity_rad_s and coupler:
///
///     1    without clearance a flexible coupler makes no great difference
///     2-5  growth from 10 to 15 rad/s: 8.5 and 4 times with 0.25 mm, 3.5 and 1.25 times with 0.5 mm,
///          rigid and flexible coupler
///     6    at 15 rad/s peaks are smaller with 0.5 mm than with 0.25 mm
///     7    at 15 rad/s peaks are smaller with a flexible coupler than with a rigid one, the clearance
///          above 0
///
/// The text gives no velocity for 6 and 7; rows without a number say what they come to at the other
/// velocities. Each row tells the paper's ratio and that found: `paper`, `found_least` to `found_largest`, of
/// the medians over replicates. A growth holds within 20 %, statement 1 within 5 %, an order if the ratios
/// are below 0.999.
///
/// Settings: the combinations of all else that the sweep varies. With several, `found_least` and
/// `found_largest` are the medians over the settings, `share` is the part of the settings, of those that have
/// all its peaks, in which the statement holds. From kFewestSettings on `index.PARAMETER` is each parameter's
/// first-order sensitivity index of the logarithm of the statement's ratio, see calc_first_order_index();
/// null where the statement has no number.
/// @throws WrongState if the sweep does not vary clearance, crank velocity and coupler
[[nodiscard]] ResultTable hold_against_paper(const ResultTable& results);

inline constexpr std::size_t kFewestSettings = 50;

}  // namespace jobs
