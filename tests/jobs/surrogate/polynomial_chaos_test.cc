// SPDX-License-Identifier: Apache-2.0
#include "jobs/surrogate/polynomial_chaos.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "jobs/statistics/unit_points.h"

namespace jobs_tests {
namespace {

/// Points of Sobol's sequence in [-1, 1]^2.
Eigen::MatrixXd points(std::size_t count) {
  Eigen::MatrixXd inputs(static_cast<Eigen::Index>(count), 2);
  Eigen::Index row = 0;
  for (const auto& unit : jobs::sobol_points(count, 2, 1))
    inputs.row(row++) << 2.0 * unit[0] - 1.0, 2.0 * unit[1] - 1.0;
  return inputs;
}

template <typename F>
Eigen::VectorXd values(const Eigen::MatrixXd& inputs, const F& f) {
  Eigen::VectorXd response(inputs.rows());
  for (Eigen::Index k = 0; k < inputs.rows(); ++k) response[k] = f(inputs(k, 0), inputs(k, 1));
  return response;
}

TEST(PolynomialChaos, IsExactForAPolynomial) {
  const auto cubic = [](double x, double y) { return 1.0 - 2.0 * x + 3.0 * x * y * y - y * y; };
  const Eigen::MatrixXd inputs = points(40);
  const jobs::PolynomialChaos surrogate(inputs, values(inputs, cubic));
  EXPECT_GE(surrogate.degree(), 3);
  EXPECT_LT(surrogate.cross_validation_error(), 1e-12);
  EXPECT_NEAR(surrogate.predicted_part(), 1.0, 1e-12);
  const std::array<double, 2> place{0.3, -0.7};
  EXPECT_NEAR(surrogate.predict(place), cubic(0.3, -0.7), 1e-12);
}

TEST(PolynomialChaos, TakesResponsesWhoseSquaresNoDoubleHolds) {
  const Eigen::MatrixXd inputs = points(40);
  const auto response = values(inputs, [](double x, double y) { return std::sin(3.0 * x) + y; });
  const jobs::PolynomialChaos small(inputs, response), large(inputs, std::ldexp(1.0, 800) * response);
  ASSERT_EQ(large.degree(), small.degree());
  EXPECT_EQ(large.left_out_predictions(), std::ldexp(1.0, 800) * small.left_out_predictions())
      << "to the bit, by a power of two";
  EXPECT_EQ(large.predicted_part(), small.predicted_part());
}

// The closed form of leaving one out is what fitting without the point predicts there.
TEST(PolynomialChaos, PredictsAPointFromTheOthers) {
  const auto wave = [](double x, double y) { return std::sin(3.0 * x) + 0.3 * std::exp(y); };
  const Eigen::MatrixXd inputs = points(13);  // room for degree 2, without the point, too
  const Eigen::VectorXd response = values(inputs, wave);
  const jobs::PolynomialChaos all(inputs, response);
  Eigen::MatrixXd fewer = inputs.topRows(12);
  const jobs::PolynomialChaos without(fewer, response.head(12));
  ASSERT_EQ(all.degree(), without.degree());
  const std::array<double, 2> left_out{inputs(12, 0), inputs(12, 1)};
  EXPECT_NEAR(all.left_out_predictions()[12], without.predict(left_out), 1e-12);
}

TEST(PolynomialChaos, KnowsHowFarItMayBeBelieved) {
  const Eigen::MatrixXd inputs = points(64);
  const auto smooth = values(inputs, [](double x, double y) { return std::exp(x) * std::cos(y); });
  EXPECT_GT(jobs::PolynomialChaos(inputs, smooth).predicted_part(), 0.9999);
  // Signs as good as thrown: nothing is to be predicted, and the degree stays low.
  int turn = 0;
  const auto noise = values(inputs, [&](double, double) { return (++turn * 7919) % 13 < 6 ? 1.0 : -1.0; });
  EXPECT_LT(jobs::PolynomialChaos(inputs, noise).predicted_part(), 0.3);
  const jobs::PolynomialChaos constant(inputs, Eigen::VectorXd::Constant(64, 2.5));
  EXPECT_EQ(constant.predicted_part(), 1.0);
  EXPECT_NEAR(constant.predict(std::array<double, 2>{0.1, 0.2}), 2.5, 1e-12);
}

// The mean of 1.1, 1.1, ... is not 1.1 in most cases.
TEST(PolynomialChaos, TakesAConstantForPredicted) {
  for (std::size_t count = 6; count < 40; ++count)
    EXPECT_EQ(jobs::PolynomialChaos(points(count), Eigen::VectorXd::Constant(static_cast<Eigen::Index>(count), 1.1)).predicted_part(), 1.0) << count;
}

// Values without an order: no degree predicts them better than their mean does.
TEST(PolynomialChaos, PredictsNothingWhereTheMeanIsAsGood) {
  Eigen::VectorXd values(6);
  values << 1.0, -1.0, 1.0, 1.0, -1.0, -1.0;
  const jobs::PolynomialChaos surrogate(points(6), values);
  ASSERT_EQ(surrogate.degree(), 0);
  EXPECT_NEAR(surrogate.predicted_part(), 0.0, 1e-12);
}

}  // namespace
}  // namespace jobs_tests
