#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/kinematics/frame_motion.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Force and moment about a frame's origin, in W.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< [N m]
};

/// Mass, first moment and inertia about a frame's origin, in W: of a body, or of all that a frame carries.
struct SpatialInertia {
  double mass = 0.0;                                 ///< [kg]
  Eigen::Vector3d mc = Eigen::Vector3d::Zero();      ///< mass times centre of mass, [kg m]
  Eigen::Matrix3d I = Eigen::Matrix3d::Zero();       ///< [kg m^2]
};

/// Rows are read one at a time.
using TreeMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Mass matrix and bias forces of the open chains, Eqs. (5)-(7): recursive Newton-Euler and composite bodies in W,
/// each frame about its own origin (about a common one, the spin inertia of a thin rod would lose its last digits).
class TreeDynamics {
 public:
  explicit TreeDynamics(const Mechanism& mechanism);

  /// M(i, j) for j an ancestor of i or i itself; other entries stay 0.
  [[nodiscard]] const TreeMatrix& M() const { return M_; }
  [[nodiscard]] double M(FrameIndex i, FrameIndex j) const { return i > j ? M_(i, j) : M_(j, i); }
  /// Generalised forces that hold the motion given by the frames' accelerations: h + g less what the loads do.
  [[nodiscard]] const Eigen::VectorXd& bias() const { return bias_; }

  /// External forces for the next calc(); cleared by it.
  void add_load(FrameIndex frame, const Wrench& about_origin);
  void clear_loads();

  /// Computes M and bias from the frames' motions and the loads added since.
  void calc(const std::vector<FrameMotion>& frames);

 private:
  void calc_body_forces(const std::vector<FrameMotion>& frames);
  void carry_to_parents(const std::vector<FrameMotion>& frames);
  void calc_mass_matrix(const std::vector<FrameMotion>& frames);

  /// What the recursions need of a coordinate, close together.
  struct Node {
    FrameIndex parent;
    bool rotates;
    bool inside_joint;
  };

  const Mechanism& mechanism_;
  std::vector<Node> nodes_;
  std::vector<Wrench> loads_;
  std::vector<Wrench> forces_;            ///< needed to move all that a frame carries
  std::vector<SpatialInertia> composite_; ///< of all that a frame carries
  TreeMatrix M_;
  Eigen::VectorXd bias_;
};

/// Kinetic energy of the bodies, [J].
[[nodiscard]] double calc_kinetic_energy(const Mechanism& mechanism, const std::vector<FrameMotion>& frames);

/// Energy of gravity (zero at the global origin) and of the springs on coordinates, [J].
[[nodiscard]] double calc_potential_energy(const Mechanism& mechanism, const std::vector<FrameMotion>& frames, const Eigen::VectorXd& q);

}  // namespace engine
