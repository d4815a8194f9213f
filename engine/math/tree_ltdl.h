#pragma once

#include <vector>

#include <Eigen/Core>

namespace engine {

/// Factorisation H = L^T D L of a mass matrix with the sparsity of a kinematic tree: no fill-in, and separate chains never meet.
/// Source: R. Featherstone, Rigid Body Dynamics Algorithms, section 6.5.
class TreeLtdl {
 public:
  /// @param parent  for each row its parent row, smaller than the own, or -1
  explicit TreeLtdl(std::vector<int> parent)
      : parent_(std::move(parent)), H_(static_cast<Eigen::Index>(parent_.size()), static_cast<Eigen::Index>(parent_.size())) {
    H_.setZero();
  }

  /// The matrix to be factored: the entries (i, j) with j an ancestor of i or i itself.
  [[nodiscard]] Eigen::MatrixXd& matrix() { return H_; }

  /// Factors in place. False if the matrix is not positive definite.
  [[nodiscard]] bool factor() {
    bool positive = true;
    for (int k = size() - 1; k >= 0; --k) {
      positive = positive && H_(k, k) > 0.0;
      for (int i = parent(k); i >= 0; i = parent(i)) {
        const double a = H_(k, i) / H_(k, k);
        for (int j = i; j >= 0; j = parent(j)) H_(i, j) -= a * H_(k, j);
        H_(k, i) = a;
      }
    }
    return positive;
  }

  /// x <- H^-1 x after factor().
  template <typename Vector>
  void solve_in_place(Vector&& x) const {
    for (int i = size() - 1; i >= 0; --i)
      for (int j = parent(i); j >= 0; j = parent(j)) x[j] -= H_(i, j) * x[i];
    for (int i = 0; i < size(); ++i) {
      x[i] /= H_(i, i);
      for (int j = parent(i); j >= 0; j = parent(j)) x[i] -= H_(i, j) * x[j];
    }
  }

 private:
  [[nodiscard]] int size() const { return static_cast<int>(parent_.size()); }
  [[nodiscard]] int parent(int i) const { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<int> parent_;
  Eigen::MatrixXd H_;
};

}  // namespace engine
