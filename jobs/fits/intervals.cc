// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/SVD>
#include <boost/math/distributions/fisher_f.hpp>

#include "engine/errors.h"
#include "jobs/fits/autoregression.h"
#include "jobs/parameters/unit_scale.h"

namespace jobs {
namespace {

constexpr double kTakesPart = 0.1;  // least share of a parameter in a direction

/// factor A^T A
Eigen::MatrixXd calc_gram(double factor, const Eigen::MatrixXd& A) { return factor * A.transpose() * A; }

/// A M A^T
Eigen::MatrixXd calc_congruent(const Eigen::MatrixXd& A, const Eigen::MatrixXd& M) {
  return A * M * A.transpose();
}

/// J^T V J and the effective samples of residuals in series.
struct SeriesNoise {
  Eigen::MatrixXd middle;
  double effective_samples = 0.0;
};

/// A J^T of which J^T V J is the square: the columns of J run backwards through the model's filter.
Eigen::MatrixXd filter_backwards(const Eigen::MatrixXd& jacobian, const std::vector<double>& coefficients) {
  Eigen::MatrixXd filtered = jacobian;
  const auto order = static_cast<Eigen::Index>(coefficients.size());
  for (Eigen::Index t = filtered.rows() - 1; t >= 0; --t) {
    for (Eigen::Index k = 1; k <= order && t + k < filtered.rows(); ++k)
      filtered.row(t) += coefficients[static_cast<std::size_t>(k - 1)] * filtered.row(t + k);
  }
  return filtered;
}

SeriesNoise calc_series_noise(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals,
                              std::vector<std::size_t> blocks) {
  if (blocks.empty()) blocks.push_back(static_cast<std::size_t>(residuals.size()));
  const auto total = std::accumulate(blocks.begin(), blocks.end(), std::size_t{0});
  engine::require(total == static_cast<std::size_t>(residuals.size()), "blocks", "as long as the residuals");
  // The fit has taken the variance of n residuals.
  const double taken =
      static_cast<double>(jacobian.rows()) / static_cast<double>(jacobian.rows() - jacobian.cols());
  SeriesNoise noise{Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols()), 0.0};
  Eigen::Index from = 0;
  for (const std::size_t length : blocks) {
    const auto rows = static_cast<Eigen::Index>(length);
    const Autoregression model = fit_autoregression({residuals.data() + from, length});
    const Eigen::MatrixXd filtered = filter_backwards(jacobian.middleRows(from, rows), model.coefficients);
    noise.middle += calc_gram(taken * model.innovation, filtered);
    noise.effective_samples += static_cast<double>(length) / std::max(calc_autocorrelation_time(model), 1.0);
    from += rows;
  }
  return noise;
}

/// The same of runs that scatter, by at least 1 in the mean, the scale of the residuals. The measured signals
/// are one run more.
SeriesNoise calc_replicate_noise(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& replicates) {
  const auto count = static_cast<double>(replicates.cols());
  const Eigen::MatrixXd off = replicates.colwise() - replicates.rowwise().mean().eval();
  const Eigen::MatrixXd scatter_along = off.transpose() * jacobian;
  const double mean_square = off.squaredNorm() / (count - 1.0) / static_cast<double>(off.rows());
  const double factor = (1.0 + 1.0 / count) / (count - 1.0);
  if (!(mean_square > 0.0)) return {calc_gram(1.0, jacobian), count};
  return {calc_gram(factor * std::max(1.0, 1.0 / mean_square), scatter_along), count};
}

/// Columns of the directions along which the data do not decide.
std::vector<std::size_t> find_unidentifiable(const Eigen::VectorXd& singular,
                                             const Eigen::VectorXd& deviations, double quantile,
                                             double least_ratio) {
  std::vector<std::size_t> found;
  for (Eigen::Index k = 0; k < singular.size(); ++k) {
    const bool flat = !(singular[k] > least_ratio * singular[0]);
    if (flat || quantile * deviations[k] > 0.5) found.push_back(static_cast<std::size_t>(k));
  }
  return found;
}

/// Covariances of the coordinates along the directions.
struct DirectionCovariance {
  Eigen::MatrixXd white, used;
};

DirectionCovariance calc_direction_covariance(const FitIntervals& intervals, const Eigen::MatrixXd& middle) {
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(intervals.singular_values.size());
  for (Eigen::Index k = 0; k < inverse.size(); ++k) {
    const double value = intervals.singular_values[k];
    if (value > 1e-14 * intervals.singular_values[0]) inverse[k] = 1.0 / value;
  }
  const Eigen::MatrixXd squares = inverse.cwiseAbs2().asDiagonal();
  const double variance = intervals.residual_deviation * intervals.residual_deviation;
  const Eigen::MatrixXd left = squares * intervals.directions.transpose();
  const Eigen::MatrixXd middle_along = left * middle;
  const Eigen::MatrixXd along = middle_along * intervals.directions;
  return {variance * squares, along * squares};
}

void drop_directions(const std::vector<std::size_t>& dropped, Eigen::MatrixXd& covariance) {
  for (const std::size_t column : dropped) {
    covariance.row(static_cast<Eigen::Index>(column)).setZero();
    covariance.col(static_cast<Eigen::Index>(column)).setZero();
  }
}

void set_deviations(FitIntervals& intervals, const Eigen::MatrixXd& white) {
  const Eigen::Index n = white.rows();
  intervals.deviations = intervals.covariance.diagonal().cwiseSqrt();
  intervals.inflation = Eigen::VectorXd::Ones(n);
  intervals.correlation = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (white(i, i) > 0.0) intervals.inflation[i] = intervals.covariance(i, i) / white(i, i);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double size = intervals.deviations[i] * intervals.deviations[j];
      if (i != j && size > 0.0) intervals.correlation(i, j) = intervals.covariance(i, j) / size;
    }
  }
  for (const std::size_t column : intervals.unidentifiable) {
    for (Eigen::Index i = 0; i < n; ++i) {
      if (std::abs(intervals.directions(i, static_cast<Eigen::Index>(column))) >= kTakesPart)
        intervals.deviations[i] = std::numeric_limits<double>::infinity();
    }
  }
}

std::vector<Estimate> calc_estimates(const FitIntervals& intervals, std::span<const Span> spans,
                                     std::span<const double> x) {
  std::vector<Estimate> estimates;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const double part = part_at(spans[i], x[i]);
    const double reach = intervals.quantile * intervals.deviations[static_cast<Eigen::Index>(i)];
    // On a logarithmic scale 0 is infinitely far away, and would look like a value.
    const double low = std::isinf(reach) ? -reach : value_at(spans[i], part - reach);
    estimates.push_back({x[i], low, value_at(spans[i], part + reach)});
  }
  return estimates;
}

std::string join(const std::vector<std::string>& words) {
  std::string joined;
  for (std::size_t k = 0; k < words.size(); ++k)
    joined += (k == 0 ? "" : k + 1 == words.size() ? " and "
                                                   : ", ") +
              words[k];
  return joined;
}

std::string describe_direction(const std::vector<std::string>& rising,
                               const std::vector<std::string>& falling) {
  std::vector<std::string> all = rising;
  all.insert(all.end(), falling.begin(), falling.end());
  if (all.size() == 1)
    return all.front() + " has no influence on the measured channels that could be told from their noise.";
  const std::string subject = all.size() == 2 ? all[0] + " cannot be told from " + all[1]
                                              : join(all) + " cannot be told from each other";
  if (rising.empty() || falling.empty())
    return subject + ": raising " + (all.size() == 2 ? "both" : "all of them") +
           " together changes the measured channels too little.";
  return subject + ": " + join(rising) + " raised with " + join(falling) +
         " lowered leaves the measured channels as they are.";
}

}  // namespace

FitIntervals calc_intervals(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals,
                            std::span<const Span> spans, std::span<const double> x,
                            const IntervalOptions& options) {
  const Eigen::Index n = jacobian.cols();
  engine::require(jacobian.rows() > n, "residuals", "more than the parameters");
  FitIntervals intervals;
  const auto freedom = static_cast<double>(jacobian.rows() - n);
  intervals.residual_deviation = std::sqrt(residuals.squaredNorm() / freedom);
  // BDCSVD takes the compiler ten seconds more, and gains nothing where columns are few.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinV);
  intervals.singular_values = svd.singularValues();
  intervals.directions = svd.matrixV();
  const double variance = intervals.residual_deviation * intervals.residual_deviation;
  SeriesNoise noise{calc_gram(variance, jacobian), static_cast<double>(jacobian.rows())};
  const bool has_replicates = options.replicates.cols() > n;
  if (has_replicates) {
    noise = calc_replicate_noise(jacobian, options.replicates);
    noise.middle *= std::max(1.0, variance);
  } else if (options.noise == ResidualNoise::kAutocorrelated) {
    noise = calc_series_noise(jacobian, residuals, options.blocks);
  }
  intervals.effective_samples = noise.effective_samples;
  const double degrees = std::max(noise.effective_samples - static_cast<double>(n), 1.0);
  const auto parameters = static_cast<double>(n);
  const double hotelling = has_replicates ? (noise.effective_samples - 1.0) / degrees : 1.0;
  const double fisher = boost::math::quantile(boost::math::fisher_f(parameters, degrees), 0.95);
  intervals.quantile = std::sqrt(hotelling * parameters * fisher);
  const double added = options.misfit / (intervals.quantile * intervals.quantile);
  noise.middle += calc_gram(added, jacobian);
  DirectionCovariance along = calc_direction_covariance(intervals, noise.middle);
  intervals.unidentifiable = find_unidentifiable(intervals.singular_values, along.used.diagonal().cwiseSqrt(),
                                                 intervals.quantile, options.least_ratio);
  drop_directions(intervals.unidentifiable, along.used);
  drop_directions(intervals.unidentifiable, along.white);
  intervals.covariance = calc_congruent(intervals.directions, along.used);
  set_deviations(intervals, calc_congruent(intervals.directions, along.white));
  intervals.parameters = calc_estimates(intervals, spans, x);
  return intervals;
}

std::vector<std::string> describe_unidentifiable(std::span<const std::string> names,
                                                 const FitIntervals& intervals) {
  std::vector<std::string> sentences;
  for (const std::size_t column : intervals.unidentifiable) {
    Eigen::VectorXd direction = intervals.directions.col(static_cast<Eigen::Index>(column));
    Eigen::Index largest = 0;
    direction.cwiseAbs().maxCoeff(&largest);
    if (direction[largest] < 0.0) direction = -direction;
    std::vector<std::string> rising, falling;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double share = direction[static_cast<Eigen::Index>(i)];
      if (std::abs(share) >= kTakesPart) (share > 0.0 ? rising : falling).push_back(names[i]);
    }
    sentences.push_back(describe_direction(rising, falling));
  }
  return sentences;
}

}  // namespace jobs
