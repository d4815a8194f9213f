// SPDX-License-Identifier: Apache-2.0
#include "jobs/surrogate/polynomial_chaos.h"

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/QR>

namespace jobs {
namespace {

constexpr int kLargestDegree = 12;
constexpr double kPointsPerTerm = 2.0;
constexpr double kMostTerms = 300.0;  // as many as can be fitted while a user waits

/// All lists of degrees whose sum is at most the degree.
void add_exponents(std::size_t inputs, int degree, std::vector<int>& begun,
                   std::vector<std::vector<int>>& exponents) {
  if (begun.size() == inputs) return exponents.push_back(begun);
  for (int d = 0; d <= degree; ++d) {
    begun.push_back(d);
    add_exponents(inputs, degree - d, begun, exponents);
    begun.pop_back();
  }
}

std::vector<std::vector<int>> make_exponents(std::size_t inputs, int degree) {
  std::vector<std::vector<int>> exponents;
  std::vector<int> begun;
  add_exponents(inputs, degree, begun, exponents);
  return exponents;
}

/// Number of terms: (inputs + degree) over degree.
double count_terms(std::size_t inputs, int degree) {
  double count = 1.0;
  for (int d = 1; d <= degree; ++d) count *= (static_cast<double>(inputs) + d) / d;
  return count;
}

/// sqrt(2 d + 1) P_d(x): orthonormal for x uniform in [-1, 1].
std::vector<double> legendre(double x, int degree) {
  std::vector<double> p{1.0, x};
  for (int d = 2; d <= degree; ++d) {
    const auto k = static_cast<std::size_t>(d);
    p.push_back(((2.0 * d - 1.0) * x * p[k - 1] - (d - 1.0) * p[k - 2]) / d);
  }
  for (std::size_t d = 0; d < p.size(); ++d) p[d] *= std::sqrt(2.0 * static_cast<double>(d) + 1.0);
  return p;
}

Eigen::RowVectorXd terms_at(std::span<const double> input, const std::vector<std::vector<int>>& exponents,
                            int degree) {
  std::vector<std::vector<double>> polynomials;
  for (const double x : input) polynomials.push_back(legendre(x, degree));
  Eigen::RowVectorXd terms(static_cast<Eigen::Index>(exponents.size()));
  for (std::size_t t = 0; t < exponents.size(); ++t) {
    double product = 1.0;
    for (std::size_t i = 0; i < input.size(); ++i)
      product *= polynomials[i][static_cast<std::size_t>(exponents[t][i])];
    terms[static_cast<Eigen::Index>(t)] = product;
  }
  return terms;
}

/// A row of terms a point.
Eigen::MatrixXd make_design_matrix(const Eigen::MatrixXd& inputs,
                                   const std::vector<std::vector<int>>& exponents, int degree) {
  Eigen::MatrixXd design(inputs.rows(), static_cast<Eigen::Index>(exponents.size()));
  for (Eigen::Index k = 0; k < inputs.rows(); ++k) {
    const Eigen::VectorXd point = inputs.row(k);
    design.row(k) =
        terms_at(std::span(point.data(), static_cast<std::size_t>(point.size())), exponents, degree);
  }
  return design;
}

/// A power of two, by which no digit changes, near the largest value. Squares of large values would be
/// infinite, and no degree better than none.
double scale_of(const Eigen::VectorXd& response) {
  const double largest = response.cwiseAbs().maxCoeff();
  return largest > 0.0 ? std::exp2(std::ilogb(largest)) : 1.0;
}

}  // namespace

struct PolynomialChaos::Fit {
  int degree = 0;
  std::vector<std::vector<int>> exponents{};
  Eigen::VectorXd coefficients{}, left_out{};
  double error = std::numeric_limits<double>::infinity();
};

PolynomialChaos::Fit PolynomialChaos::fit(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& response,
                                          int degree) {
  Fit made{.degree = degree, .exponents = make_exponents(static_cast<std::size_t>(inputs.cols()), degree)};
  const Eigen::MatrixXd design = make_design_matrix(inputs, made.exponents, degree);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design);
  if (qr.rank() < design.cols()) return made;  // on a grid of few values high degrees are not told apart
  made.coefficients = qr.solve(response);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(design.rows(), design.cols());
  const Eigen::ArrayXd free = 1.0 - basis.rowwise().squaredNorm().array();
  if (free.minCoeff() < 1e-9) return made;  // a point that nothing else says anything of
  const Eigen::ArrayXd errors = (response - design * made.coefficients).array() / free;
  made.left_out = response.array() - errors;
  made.error = std::sqrt(errors.square().mean());
  return made;
}

PolynomialChaos::Fit PolynomialChaos::find_best_fit(const Eigen::MatrixXd& inputs,
                                                    const Eigen::VectorXd& response) {
  Fit best;
  for (int degree = 0; degree <= kLargestDegree; ++degree) {
    const double terms = count_terms(static_cast<std::size_t>(inputs.cols()), degree);
    if (terms > kMostTerms || kPointsPerTerm * terms > static_cast<double>(inputs.rows())) break;
    Fit next = fit(inputs, response, degree);
    if (next.error < best.error) best = std::move(next);
  }
  return best;
}

PolynomialChaos::PolynomialChaos(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& given) {
  const double scale = scale_of(given);
  const Eigen::VectorXd response = given / scale;
  Fit best = find_best_fit(inputs, response);
  degree_ = best.degree;
  exponents_ = std::move(best.exponents);
  coefficients_ = scale * best.coefficients;
  left_out_ = scale * best.left_out;
  error_ = scale * best.error;
  constexpr double kRounding = 1e-12;  // of the largest response
  // The mean of the other points errs by n / (n - 1) times the deviation from that of all.
  const auto n = static_cast<double>(response.size());
  const double mean_error = n / (n - 1.0) * std::sqrt((response.array() - response.mean()).square().mean());
  const bool varies = mean_error > kRounding * response.cwiseAbs().maxCoeff();
  predicted_part_ = varies ? 1.0 - best.error * best.error / (mean_error * mean_error) : 1.0;
}

double PolynomialChaos::predict(std::span<const double> input) const {
  return terms_at(input, exponents_, degree_).dot(coefficients_);
}

}  // namespace jobs
