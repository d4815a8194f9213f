// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "jobs/motion/poincare.h"
#include "jobs/results/result_table.h"

namespace jobs {

/// The growth of the distance between two runs that began nearly alike.
struct Divergence {
  /// Slope of the logarithm of the distance over time, by least squares, [1/s]
  double exponent = 0.0;
  double from = 0.0, to = 0.0;     ///< the stretch that it was measured on, [s]
};

/// Measures how two neighbouring runs part: from where their distance first exceeds 1e-5 of the motion's own
/// size (below it is rounding) up to where it exceeds 0.1 of it (beyond, it is as far as the motion allows).
/// The size is the root mean square deviation from the mean.
/// @param t  [s], rising
/// @param a, b  columns of each run, one a coordinate, as long as t
/// @returns empty if the runs do not part so far, or at once (within fewer than 8 samples, or after coming
///     closer)
[[nodiscard]] std::optional<Divergence> measure_divergence(std::span<const double> t,
                                                           const std::vector<std::vector<double>>& a,
                                                           const std::vector<std::vector<double>>& b);

/// The largest Lyapunov exponent of each set of replicates of a sweep, from the runs that begin with slightly
/// different stiffness beside the one that does not: by the journal's position in the bearing. A row a set:
/// what is swept, pairs, pairs_diverged, exponent_1_s (the mean over those), exponent_low_1_s and
/// exponent_high_1_s (95 % confidence, Student's), from_s and to_s (the mean stretch that was measured).
/// @param results  rows with job_id, replicate and the columns of `axes`
/// @throws WrongState if the sweep has no replicates, or more rows than kMostJobsOfDiagram
[[nodiscard]] ResultTable make_lyapunov(const nlohmann::json& axes, const ResultTable& results,
                                        const FindTrajectory& find);

}  // namespace jobs
