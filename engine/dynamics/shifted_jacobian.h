#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "engine/dynamics/equations.h"

namespace engine {

/// The matrix (shift 1 - J) of a linearly implicit step, J the Jacobian of MotionSystem's state equation.
///
/// Coordinates follow their rates, each bristle answers itself alone, and nothing depends on works and losses: eliminating all of these
/// leaves a matrix of the free coordinates' number to be factored.
class ShiftedJacobian {
 public:
  ShiftedJacobian(int free_coordinates, int bristles, int drives);

  /// Where the derivatives go.
  [[nodiscard]] Linearisation& linearisation() { return derivatives_; }
  /// df/dt. Call after the derivatives have been written.
  void calc_time_derivative(Eigen::VectorXd& by_t) const;

  /// Factors (shift 1 - J). False if it is singular.
  [[nodiscard]] bool factor(double shift);
  /// x <- (shift 1 - J)^-1 x after factor().
  void solve_in_place(Eigen::VectorXd& x);

 private:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  int free_, bristles_, rates_of_work_;
  Matrix by_q_, by_v_, by_bristle_;    ///< rows: accelerations, rates of acting bristles, of work and losses
  Eigen::VectorXd by_t_;
  std::vector<int> acting_;
  Linearisation derivatives_;

  double inverse_shift_ = 0.0;
  Matrix reduced_;                     ///< free x free
  Eigen::PartialPivLU<Matrix> lu_;
  Matrix bristle_response_;            ///< of the acting bristles to the free rates
  std::vector<Eigen::Matrix2d> bristle_inverse_;
  Eigen::VectorXd rate_, bristle_;     ///< parts of a solution
};

}  // namespace engine
