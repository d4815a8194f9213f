#include <cstddef>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

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
