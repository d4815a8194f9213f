// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "jobs/motion/poincare.h"
#include "jobs/results/result_table.h"
#include "jobs/statistics/estimate.h"

namespace jobs {

/// Positions of one run: a column a coordinate, a row a sample.
using Orbit = std::vector<std::vector<double>>;

/// Growth of the distances between a run and its neighbours.
struct Divergence {
  std::size_t parted = 0;            ///< neighbours that came as far from the run as the motion allows
  /// Largest Lyapunov exponent, [1/s]; its interval is infinite if there are too few samples for one. Empty:
  /// every neighbour had parted before the measurement began
  std::optional<Estimate> exponent;
  double from = 0.0, to = 0.0;       ///< the mean stretch that it was measured on, [s]
};

/// Measures the largest Lyapunov exponent from runs that begin nearly alike, by the mean rate at which the
/// logarithm of their distance d grows:
///
///     exponent = sum_k [ln d_k(to_k) - ln d_k(from_k)] / sum_k (to_k - from_k)        over the neighbours k
///
/// Sources: G. Benettin, L. Galgani and J.-M. Strelcyn, Kolmogorov entropy and numerical experiments, Phys.
/// Rev. A 14 (1976) 2338-2345 (mean of the logarithms of stretching); A. Wolf et al., Determining Lyapunov
/// exponents from a time series, Physica D 16 (1985) 285-317 (stretches of different length: sum over sum);
/// M. T. Rosenstein, J. J. Collins and C. J. De Luca, Physica D 65 (1993) 117-134, and H. Kantz, Phys. Lett.
/// A 185 (1994) 77-87 (logarithms are averaged over neighbours, not distances).
///
/// Stretch of a neighbour: it begins with the first sample, not before `begin`, nor in the first twentieth of
/// the run, at which d exceeds 1e-6 of the motion's size: below is rounding. It ends where d first exceeds
/// 0.1 of the size, which is as far as the motion allows, or with the run, or where d falls below 1e-7 for
/// good. Neighbours that do not part count with their whole stretch: begin and end depend on the past only,
/// so that by Wald's identity the mean of a distance that wanders without growing is zero. Where no neighbour
/// gets so far away before the last quarter of the run, all are measured from `begin` on.
/// d is the root mean square distance over the last hundredth of the run, as of delay vectors (Kantz), since
/// the distance of positions alone passes zero. The size is the root mean square deviation from the mean.
///
/// Interval: with 95 % confidence, over 20 blocks of time. In the linear regime the distances of all
/// neighbours are proportional to one another, so that n neighbours are one sample, not n. Blocks of time
/// show how the rate varies, whether or not neighbours agree. A distance that grows or shrinks with the first
/// power of time, as distances of regular motions may, is not distinguished from an exponent: the interval is
/// wider by what that would be, ln(to / from) / (to - from), on both sides.
class DivergenceMeasurement {
 public:
  /// @param t  [s], rising; at its front the runs begin to differ  @param run  as many samples
  DivergenceMeasurement(std::span<const double> t, Orbit run, double begin);
  /// Adds a neighbour, which may have fewer samples.
  void add(const Orbit& neighbour);
  [[nodiscard]] Divergence finish() const;

 private:
  /// Curve of ln d at samples_, as far as the neighbour goes; d in units of size_.
  [[nodiscard]] std::vector<double> calc_log_distances(const Orbit& neighbour) const;

  Orbit run_;
  double start_ = 0.0;
  double size_ = 0.0;
  std::size_t delay_ = 1;                ///< samples that a distance is taken over
  std::vector<std::size_t> samples_;     ///< at which curves have points
  std::vector<double> times_;            ///< of these
  std::vector<std::vector<double>> curves_;  ///< one a neighbour
};

/// The largest Lyapunov exponent of each set of replicates of a sweep, from the runs that begin with slightly
/// different stiffness beside the one that does not: by the journals' positions in the joints with clearance,
/// after the run-up. A row a set: what is swept, pairs, pairs_diverged, exponent_1_s, exponent_low_1_s,
/// exponent_high_1_s, from_s and to_s, see Divergence.
/// @param results  rows with job_id, replicate, the columns of `axes`, and run_up_s unless that is 0
/// @throws WrongState if the sweep has no replicates, more rows than kMostJobsOfDiagram, or a job without
///     clearance
[[nodiscard]] ResultTable make_lyapunov(const nlohmann::json& axes, const ResultTable& results,
                                        const RunReader& reader);

}  // namespace jobs
