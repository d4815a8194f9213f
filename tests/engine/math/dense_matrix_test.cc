// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <complex>
#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "engine/math/complex.h"
#include "engine/math/dense_matrix.h"

namespace engine {
namespace {

/// Zeros on the diagonal: rows have to be exchanged.
Eigen::MatrixXd draw_matrix(Eigen::Index n, std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  return Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index i, Eigen::Index j) { return i == j ? 0.0 : entry(random); });
}

struct Given : DenseMatrix<double> {
  explicit Given(const Eigen::MatrixXd& A) : DenseMatrix(static_cast<std::size_t>(A.rows())) {
    resize(static_cast<std::size_t>(A.rows()));
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      for (Eigen::Index j = 0; j < A.cols(); ++j) (*this)(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) = A(i, j);
  }
};

TEST(DenseMatrix, SolvesAsEigenDoes) {
  std::mt19937 random(7);
  for (const Eigen::Index n : {2, 3, 5, 8}) {
    for (int draw = 0; draw < 20; ++draw) {
      const Eigen::MatrixXd A = draw_matrix(n, random);
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
      const Eigen::FullPivLU<Eigen::MatrixXd> reference(A);
      const double rounding = 1e-14 / reference.rcond();
      Given dense(A);
      ASSERT_TRUE(dense.factor());
      Eigen::VectorXd x = b, transposed = b;
      dense.solve_in_place(x.data());
      dense.solve_transposed_in_place(transposed.data());
      EXPECT_LE((x - reference.solve(b)).norm(), rounding * x.norm());
      EXPECT_LE((transposed - Eigen::VectorXd(A.transpose().fullPivLu().solve(b))).norm(), rounding * transposed.norm());
      EXPECT_NEAR(dense.determinant(), A.determinant(), 1e-13);
    }
  }
}

TEST(DenseMatrix, OfComplexNumbersSolvesAsEigenDoes) {
  std::mt19937 random(8);
  for (const Eigen::Index n : {2, 3, 5, 8}) {
    for (int draw = 0; draw < 20; ++draw) {
      Eigen::MatrixXcd A(n, n);
      A.real() = draw_matrix(n, random);
      A.imag() = draw_matrix(n, random);
      DenseMatrix<Complex<double>> dense(static_cast<std::size_t>(n));
      dense.resize(static_cast<std::size_t>(n));
      std::vector<Complex<double>> x(static_cast<std::size_t>(n));
      Eigen::VectorXcd b(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        b[i] = {1.0, static_cast<double>(i)};
        x[static_cast<std::size_t>(i)] = {b[i].real(), b[i].imag()};
        for (Eigen::Index j = 0; j < n; ++j) dense(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) = {A(i, j).real(), A(i, j).imag()};
      }
      ASSERT_TRUE(dense.factor());
      dense.solve_in_place(x.data());
      const Eigen::FullPivLU<Eigen::MatrixXcd> reference(A);
      const Eigen::VectorXcd expected = reference.solve(b);
      double difference = 0.0;
      for (Eigen::Index i = 0; i < n; ++i) {
        const Complex<double>& found = x[static_cast<std::size_t>(i)];
        difference = std::max(difference, std::abs(std::complex<double>(found.real, found.imag) - expected[i]));
      }
      EXPECT_LE(difference, 1e-14 / reference.rcond() * expected.norm());
    }
  }
}

TEST(DenseMatrix, SaysThatAMatrixIsSingular) {
  Eigen::Matrix3d A;
  A << 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 4.0, 5.0;
  EXPECT_FALSE(Given(A).factor());
}

TEST(DenseMatrix, OfNoRowsIsSolved) {
  Given empty(Eigen::MatrixXd(0, 0));
  EXPECT_TRUE(empty.factor());
  EXPECT_EQ(empty.determinant(), 1.0);
}

}  // namespace
}  // namespace engine
