#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/equations.h"

namespace engine {

/// The matrix (shift 1 - J) of a linearly implicit step, J the Jacobian of MotionSystem's state equation.
///
/// Coordinates follow their rates, each bristle answers itself alone, and nothing depends on works and losses: eliminating all of these
/// leaves a matrix of the free coordinates' number to be factored. With a = (by_q, by_v, by_z) y for the accelerations, the same for the
/// bristles' rates and those of work and loss, K = by_v + by_q / shift, and x = (q, v, z, w) as given:
///
///     known = (v, z, w) + by_q q / shift,   own_z = shift 1 - by_z of the bristles' rates
///     (shift 1 - K_v - by_z_v own_z^-1 K_z) v = known_v + by_z_v own_z^-1 known_z
///     q = (q + v) / shift,   z = own_z^-1 (known_z + K_z v),   w = (known_w + K_w v + by_z_w z) / shift
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
  // N: the number of free coordinates as the compiler knows it, 0 if it does not.
  template <int N>
  bool factor_sized(double shift);
  template <int N>
  void reduce(double shift);
  template <int N>
  bool factor_reduced();
  template <int N>
  void solve_sized(double* state);
  template <int N>
  void solve_reduced(const double* known, double* x) const;
  template <int N>
  [[nodiscard]] int size() const {
    return N > 0 ? N : free_;
  }

  int free_, bristles_, rates_of_work_;
  std::vector<double> by_q_, by_v_, by_bristle_;  ///< row after row: accelerations, rates of acting bristles, of work and losses
  std::vector<double> by_t_;
  std::vector<int> acting_;
  Linearisation derivatives_;

  double inverse_shift_ = 0.0;
  std::vector<double> K_;                         ///< rows as by_v_
  std::vector<double> bristle_inverse_;           ///< own_z^-1: 2 x 2 for each pair of acting bristles, row after row
  std::vector<double> response_;                  ///< of the acting bristles to the free rates, own_z^-1 K_z
  std::vector<double> lu_;                        ///< free x free, column after column in whole pairs; those of U over their pivots
  std::vector<double> inverse_pivot_;
  std::vector<int> order_;                        ///< of the rows, as pivoting has exchanged them
  std::vector<double> scaled_q_, solution_, known_, bristle_;  ///< parts of a solution
};

}  // namespace engine
