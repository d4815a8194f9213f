// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "jobs/store/rows.h"

namespace jobs {

/// Seconds until the last job of a sweep ends.
struct TimeLeft {
  double expected_s = 0.0;
  double low_s = 0.0, high_s = 0.0;  ///< two standard deviations to either side
};

/// From what a simulated second of each kind of job has cost so far: the jobs that are left cost that, times
/// what they simulate. Where all simulate the same time, n jobs that are left cost n times the mean of the k
/// that have been computed, with the variance s^2 n (1 + n / k), since the mean is known to s / sqrt(k) only.
/// After one job, s is as large as its cost. Before, the cost is that of the kind in the store's last
/// results. A running job costs what it has not simulated yet, and what it has counts among the costs so far.
/// Where that is not known, it costs what it has not taken yet, and, if it takes longer than expected, as
/// much again as it has taken beyond that. The last job takes its time, however many threads there are.
///
/// While jobs of the sweep wait, so much of its rivals comes before its last one, in the order of
/// order_of_sweeps(): what runs; all jobs of a rival of higher priority; of one of the same priority, as many
/// jobs as wait in the sweep, since they take turns.
/// @param threads  how many jobs are computed at a time
/// @param default_executor  of sweeps that name none; rivals with another executor do not count
/// @returns empty while the cost of a kind that is left is not known
[[nodiscard]] std::optional<TimeLeft> estimate_time_left(const SweepRow& row, int threads,
                                                         std::string_view default_executor = {});

}  // namespace jobs
