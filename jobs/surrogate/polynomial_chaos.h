// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace jobs {

/// A response as a sum of products of Legendre polynomials of inputs that are uniform in [-1, 1], fitted by
/// least squares.
///
/// The total degree is the one with the least error of cross-validation among those with at most half as many
/// terms as there are points, and 300: each point is predicted from all others, e_k = (y_k - f(x_k)) / (1 -
/// h_k) with h the diagonal of the projection on the terms.
class PolynomialChaos {
 public:
  /// @param inputs    a row a point, a column an input, in [-1, 1]
  /// @param response  one a point; two points or more
  PolynomialChaos(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& response);

  [[nodiscard]] double predict(std::span<const double> input) const;

  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] std::size_t terms() const { return exponents_.size(); }
  /// Root of the mean square of the errors of cross-validation, in the response's unit.
  [[nodiscard]] double cross_validation_error() const { return error_; }
  /// The part of the response's variance that is predicted: 1 - (error / error of the mean of all other
  /// points)^2. 0 where nothing predicts better than that mean; 1 if nothing varies.
  [[nodiscard]] double predicted_part() const { return predicted_part_; }
  /// Prediction of each point from all others.
  [[nodiscard]] const Eigen::VectorXd& left_out_predictions() const { return left_out_; }

 private:
  struct Fit;
  [[nodiscard]] static Fit fit(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& response, int degree);
  /// The fit of the degree with the least error.
  [[nodiscard]] static Fit find_best_fit(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& response);

  int degree_ = 0;
  std::vector<std::vector<int>> exponents_;  ///< degrees of each term, one an input
  Eigen::VectorXd coefficients_;
  double error_ = 0.0;
  double predicted_part_ = 0.0;
  Eigen::VectorXd left_out_;
};

}  // namespace jobs
