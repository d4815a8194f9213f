// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "jobs/store/rows.h"

namespace jobs {

/// Seconds until the last job of a sweep ends, if no other sweep waits.
struct TimeLeft {
  double expected_s = 0.0;
  double low_s = 0.0, high_s = 0.0;  ///< two standard deviations to either side
};

/// From what a simulated second of each kind of job has cost so far: the jobs that are left cost that, times
/// what they simulate. Where all simulate the same time, n jobs that are left cost n times the mean of the k
/// that have been computed, with the variance s^2 n (1 + n / k), since the mean is known to s / sqrt(k) only.
/// After one job, s is as large as its cost. A running job costs what it has not taken yet, and, if it takes
/// longer than expected, as much again as it has taken beyond that. The last job takes its time, however many
/// threads there are.
/// @param threads  how many jobs are computed at a time
/// @returns empty while the cost of a kind that is left is not known
[[nodiscard]] std::optional<TimeLeft> estimate_time_left(const SweepRow& row, int threads);

}  // namespace jobs
