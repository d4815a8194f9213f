// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "jobs/parameters/span.h"
#include "jobs/statistics/estimate.h"

namespace jobs {

enum class ResidualNoise { kWhite, kAutocorrelated };

struct IntervalOptions {
  ResidualNoise noise = ResidualNoise::kAutocorrelated;
  std::vector<std::size_t>
      blocks;                 ///< lengths of the series that the residuals consist of; empty: one series
  double misfit = 0.0;        ///< part of the sum of squares that is no noise, see calc_intervals()
  /// Residuals of runs with the same parameters, a column each; else empty
  Eigen::MatrixXd replicates{};
  double least_ratio = 1e-5;  ///< of singular values: below, the errors of the differences decide
};

/// Linearised statistics of a fit, in the parts of the spans. Intervals are simultaneous (Scheffé's): with 95
/// % probability they hold the true values of all parameters. A direction is unidentifiable if its 95 %
/// interval is longer than the range, or if its singular value is below least_ratio times the largest one;
/// the covariance leaves such directions out, and the parameters that take part in them have infinite
/// intervals.
struct FitIntervals {
  std::vector<Estimate> parameters;  ///< 95 % interval of each parameter, in its unit, not cut at the bounds
  Eigen::VectorXd deviations;        ///< standard deviations of the parts; infinite if unidentifiable
  Eigen::VectorXd inflation;         ///< variance over that of white residuals
  Eigen::MatrixXd covariance;        ///< of the parts
  Eigen::MatrixXd correlation;       ///< of the parts
  Eigen::VectorXd singular_values;   ///< of the Jacobian, descending
  Eigen::MatrixXd directions;        ///< right singular vectors, a column a singular value
  std::vector<std::size_t> unidentifiable;  ///< columns of directions
  double residual_deviation = 0.0;          ///< s, with the divisor m - n
  double effective_samples = 0.0;           ///< m over the autocorrelation time, series by series
  double quantile = 0.0;  ///< reach of an interval in standard deviations: sqrt(n F(0.95; n, degrees))
};

/// White residuals: covariance s^2 (J^T J)^-1 by the singular values of J. Autocorrelated residuals: (J^T
/// J)^-1 J^T V J (J^T J)^-1, where V is the covariance of an autoregressive model of each series of
/// residuals. The degrees of freedom are the effective samples less the parameters. Source: Seber & Wild
/// (2003), Nonlinear Regression, ch. 5 (intervals) and 6 (autocorrelated errors).
///
/// Replicates, more than parameters: V is their covariance, plus that of their mean. It is as much larger as
/// the residuals' mean square is above 1, or that of the replicates below: residuals are in units of their
/// scatter. The quantile is Hotelling's. Source: Anderson (2003), An Introduction to Multivariate Statistical
/// Analysis, section 5.2.
///
/// A misfit, as impacts leave that come a little too early or too late, tells nothing of how far the best
/// point is from the true one. So parameters may lie wherever the linearised model changes the sum by as
/// much: the covariance has misfit / quantile^2 (J^T J)^-1 added.
/// @param jacobian  by the parts of the spans, as LeastSquaresResult has it; more rows than columns
/// @param x         the best point
[[nodiscard]] FitIntervals calc_intervals(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals,
                                          std::span<const Span> spans, std::span<const double> x,
                                          const IntervalOptions& options);

/// A sentence on each unidentifiable direction.
[[nodiscard]] std::vector<std::string> describe_unidentifiable(std::span<const std::string> names,
                                                               const FitIntervals& intervals);

}  // namespace jobs
