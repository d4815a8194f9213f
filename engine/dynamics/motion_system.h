#pragma once

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "engine/clearance/clearance_joint.h"
#include "engine/dynamics/constraints.h"
#include "engine/dynamics/evaluation.h"
#include "engine/dynamics/tree_dynamics.h"
#include "engine/math/tree_ltdl.h"
#include "engine/model/mechanism.h"

namespace engine {

/// What came of an evaluation of the equations of motion.
enum class EvaluationStatus {
  kOk,
  kBristleMissing,  ///< an element touched that has no place in the state: widen_bristles() and step again
  kLocked,          ///< the constraints' matrix is singular
  kNonFinite,       ///< no number, or a mass matrix that is not positive definite
};

/// The mechanism as a first-order system dy/dt = f(t, y), Eqs. (13.1) and (13.2).
///
///     y = (q of the free coordinates, their rates, bristles, work of each drive, impact, friction and structural loss)
///
/// f depends on which contacts are on: that memory changes between steps only, by accept_step().
class MotionSystem {
 public:
  explicit MotionSystem(const Mechanism& mechanism);

  /// State at t = 0 for given coordinates (of all the mechanism).
  [[nodiscard]] Eigen::VectorXd make_state(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) const;
  /// An Evaluation with room for everything, so that evaluating allocates nothing.
  [[nodiscard]] Evaluation make_evaluation() const;

  /// Computes dy/dt and everything on the way to it. Allocates nothing.
  [[nodiscard]] EvaluationStatus calc_derivative(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt, Evaluation& at);

  /// Kinetic and potential energy of an evaluation.
  void calc_energies(Evaluation& at) const;

  /// Entries of y that error control looks at: all but work and losses.
  [[nodiscard]] Eigen::Index controlled_size() const { return 2 * free_count() + bristles_; }
  [[nodiscard]] Eigen::Index free_count() const { return static_cast<Eigen::Index>(free_.size()); }
  [[nodiscard]] const std::vector<FrameIndex>& free_coordinates() const { return free_; }

  /// Appends the penetration of every ring of every joint with clearance.
  void add_penetrations(const Evaluation& at, std::vector<Penetration>& rings) const;
  /// Lets bristles follow their contacts, before a step of dt. @returns true if any changed its place in y
  [[nodiscard]] bool prepare_step(const Evaluation& at, double dt, Eigen::VectorXd& y);
  /// Takes note of the contacts that began or ended in a step; f is another one if any did.
  [[nodiscard]] ContactChange accept_step(const Evaluation& start, const Evaluation& end, Eigen::VectorXd& y);
  /// Doubles the room for bristles in y.
  void widen_bristles(Eigen::VectorXd& y);

 private:
  void read_state(double t, const Eigen::VectorXd& y, Evaluation& at) const;
  [[nodiscard]] bool calc_contacts(const Eigen::VectorXd& y, Eigen::VectorXd& dydt, Evaluation& at);
  void add_contact_load(const CutJoint& joint, const FrameMotion& j, const Eigen::Vector3d& force_W,
                        const Eigen::Vector3d& moment_W, const std::vector<FrameMotion>& frames);
  [[nodiscard]] EvaluationStatus solve_accelerations(Evaluation& at);
  [[nodiscard]] EvaluationStatus solve_multipliers(const Evaluation& at);
  void calc_drive_forces(Evaluation& at) const;
  void calc_rates(Eigen::VectorXd& dydt, const Evaluation& at) const;

  const Mechanism& mechanism_;
  std::vector<FrameIndex> free_, driven_;
  std::vector<ClearanceJoint> clearance_joints_;
  std::vector<std::size_t> clearance_joint_of_;  ///< index into cut_joints
  Eigen::Index bristles_ = 0;

  TreeDynamics tree_;
  TreeLtdl free_mass_;
  Constraints constraints_;
  Eigen::VectorXd free_force_;      ///< right-hand side, then accelerations, of the free coordinates
  Eigen::MatrixXd free_Phi_q_t_;    ///< Phi_q of the free coordinates, transposed
  Eigen::MatrixXd response_;        ///< M^-1 Phi_q^T
  Eigen::MatrixXd A_;               ///< Phi_q M^-1 Phi_q^T
  Eigen::LLT<Eigen::MatrixXd> A_llt_;
  Eigen::VectorXd lambda_;
};

}  // namespace engine
