#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace engine {

/// Factorisation H = L^T D L of a mass matrix with the sparsity of a kinematic tree: no fill-in, and separate chains never meet.
/// Each row is treated as dense from its first ancestor on: what is not an ancestor in between stays zero, and the inner loops are plain.
/// Source: R. Featherstone, Rigid Body Dynamics Algorithms, section 6.5.
class TreeLtdl {
 public:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// @param parent  for each row its parent row, smaller than the own, or -1
  explicit TreeLtdl(const std::vector<int>& parent) {
    const auto n = static_cast<Eigen::Index>(parent.size());
    H_.setZero(n, n);
    for (std::size_t k = 0; k < parent.size(); ++k)
      first_.push_back(parent[k] < 0 ? static_cast<Eigen::Index>(k) : first_[static_cast<std::size_t>(parent[k])]);
  }

  /// The matrix to be factored: its lower triangle, of which only entries from first(row) on are read.
  [[nodiscard]] Matrix& matrix() { return H_; }
  [[nodiscard]] Eigen::Index first(Eigen::Index row) const { return first_[static_cast<std::size_t>(row)]; }

  /// Factors in place. False if the matrix is not positive definite.
  [[nodiscard]] bool factor() {
    for (Eigen::Index k = H_.rows() - 1; k >= 0; --k) {
      double* row = H_.row(k).data();
      if (!(row[k] > 0.0)) return false;
      const double inverse = 1.0 / row[k];
      for (Eigen::Index i = k - 1; i >= first(k); --i) {
        const double a = row[i] * inverse;
        double* above = H_.row(i).data();
        for (Eigen::Index j = first(k); j <= i; ++j) above[j] -= a * row[j];
        row[i] = a;
      }
      row[k] = inverse;  // D^-1 is what solving needs
    }
    return true;
  }

  /// x <- H^-1 x after factor().
  template <typename Vector>
  void solve_in_place(Vector&& x) const {
    for (Eigen::Index i = H_.rows() - 1; i >= 0; --i)
      for (Eigen::Index j = first(i); j < i; ++j) x[j] -= H_(i, j) * x[i];
    for (Eigen::Index i = 0; i < H_.rows(); ++i) {
      double sum = x[i] * H_(i, i);
      for (Eigen::Index j = first(i); j < i; ++j) sum -= H_(i, j) * x[j];
      x[i] = sum;
    }
  }

 private:
  Matrix H_;
  std::vector<Eigen::Index> first_;  ///< of each row: its eldest ancestor
};

}  // namespace engine
