#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "engine/dynamics/constraints.h"
#include "engine/dynamics/evaluation.h"
#include "engine/dynamics/tree_dynamics.h"
#include "engine/model/mechanism.h"

namespace engine {

/// The mechanism with every cut joint ideal, every driven coordinate given and every spring at rest: pure geometry.
class LoopClosure {
 public:
  explicit LoopClosure(const Mechanism& mechanism);

  /// True if the drives alone decide the motion: as many constraint rows as unknown coordinates, and no spring among the coordinates.
  [[nodiscard]] bool is_determined() const;

  /// Closes the loops at time t by Newton's method from each coordinate's assembly_guess, and solves for the velocities.
  /// @returns false if they do not close; residual() then says by how much
  [[nodiscard]] bool assemble(double t, Evaluation& at);

  /// Position, velocity, acceleration, joint reactions and drive forces at time t of a determined mechanism, starting from a position nearby.
  /// @returns false if the loops do not close there: the mechanism locks
  [[nodiscard]] bool solve(double t, Evaluation& at);

  /// Largest entry of Phi after the last attempt, [m] or [1].
  [[nodiscard]] double residual() const { return constraints_.Phi.size() ? constraints_.Phi.cwiseAbs().maxCoeff() : 0.0; }

 private:
  void set_drives(double t, Evaluation& at) const;
  void calc_rows(Evaluation& at);
  [[nodiscard]] bool close_position(Evaluation& at);
  void solve_velocity(Evaluation& at);
  void solve_forces(Evaluation& at);

  Mechanism ideal_;
  std::vector<FrameIndex> unknown_;
  Constraints constraints_;
  TreeDynamics tree_;
  Eigen::MatrixXd J_;  ///< Phi_q of the unknown coordinates
  Eigen::PartialPivLU<Eigen::MatrixXd> J_lu_;
};

}  // namespace engine
