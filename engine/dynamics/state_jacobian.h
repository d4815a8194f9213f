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
  StateJacobian(StateJacobian&&) = default;  // its derivatives lie in the vectors, which move with it
  StateJacobian& operator=(StateJacobian&&) = default;
  /// With room for all.
  void make_matrices();

  [[nodiscard]] Linearisation& derivatives() { return derivatives_; }
  [[nodiscard]] const Linearisation& derivatives() const { return derivatives_; }
  /// df/dt. Call after the derivatives have been written.
  void calc_time_derivative(Eigen::VectorXd& by_t) const;

 private:
  int free_, bristles_;
  std::vector<double> by_t_, by_q_, by_v_, by_bristle_, rates_by_t_, rates_by_q_, rates_by_v_, rates_by_own_;
  std::vector<int> acting_;
  Linearisation derivatives_;
};

}  // namespace engine
