#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/equations.h"

namespace engine {

/// The Jacobian J of MotionSystem's state equation, as far as it is not known beforehand. Coordinates follow their rates, each pair of bristles
/// answers itself and the coordinates alone, and nothing depends on works and losses.
class StateJacobian {
 public:
  /// With room for df/dt alone.
  StateJacobian(int free_coordinates, int bristles, int drives);
  /// With room for all.
  void make_matrices();

  /// Where the derivatives go.
  [[nodiscard]] Linearisation& linearisation() { return derivatives_; }
  /// df/dt. Call after the derivatives have been written.
  void calc_time_derivative(Eigen::VectorXd& by_t) const;

  [[nodiscard]] int free_coordinates() const { return free_; }
  [[nodiscard]] int bristles() const { return bristles_; }
  [[nodiscard]] int rates_of_work() const { return rates_of_work_; }
  [[nodiscard]] int acting() const { return derivatives_.bristle_count; }  ///< how many bristles act
  [[nodiscard]] const int* acting_bristles() const { return acting_.data(); }
  /// Row after row: accelerations, rates of acting bristles, of work and losses; as Linearisation has them.
  [[nodiscard]] const double* by_q() const { return by_q_.data(); }
  [[nodiscard]] const double* by_v() const { return by_v_.data(); }
  [[nodiscard]] const double* by_bristle() const { return by_bristle_.data(); }

 private:
  int free_, bristles_, rates_of_work_;
  std::vector<double> by_q_, by_v_, by_t_, by_bristle_;
  std::vector<int> acting_;
  Linearisation derivatives_;
};

}  // namespace engine
