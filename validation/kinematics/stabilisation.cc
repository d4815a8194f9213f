// SPDX-License-Identifier: Apache-2.0
#include "validation/kinematics/stabilisation.h"

#include <cstddef>
#include <stdexcept>

#include <Eigen/Geometry>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/integrate/integration.h"

namespace validation {

Violation read_violation(const Mechanism& mechanism, const Evaluation& at) {
  const CutJoint& joint = mechanism.cut_joints[0];
  const FrameMotion& coupler = at.frames[static_cast<std::size_t>(joint.bearing_frame)];
  const FrameMotion& cross_link = at.frames[static_cast<std::size_t>(joint.journal_frame)];
  const Eigen::Vector3d reach = coupler.R * joint.bearing.p;
  const Eigen::Vector3d z_b = coupler.R.col(2);
  Violation violation{Eigen::VectorXd(7), Eigen::VectorXd(7)};
  violation.Phi.head<3>() = cross_link.p - (coupler.p + reach);
  violation.Phi_d.head<3>() = cross_link.v - (coupler.v + coupler.w.cross(reach));
  for (Eigen::Index k = 0; k < 2; ++k) {
    const Eigen::Vector3d across = cross_link.R.col(k);
    violation.Phi[3 + k] = z_b.dot(across);
    violation.Phi_d[3 + k] = coupler.w.cross(z_b).dot(across) + z_b.dot(cross_link.w.cross(across));
    const Drive& drive = mechanism.drives[static_cast<std::size_t>(k)];
    const DrivenMotion driven = calc_driven_motion(drive.law, at.t);
    violation.Phi[5 + k] = at.q[drive.coordinate] - driven.q;
    violation.Phi_d[5 + k] = at.qd[drive.coordinate] - driven.qd;
  }
  return violation;
}

void integrate(const Mechanism& mechanism, const RunOptions& options, const std::function<void(Evaluation&)>& disturb,
               const ConstraintObserver::Visit& visit) {
  LoopClosure closure(mechanism);
  Evaluation start = MotionSystem(mechanism).make_evaluation();
  if (!closure.assemble(0.0, start)) throw std::runtime_error("a mechanism of the validation cannot be assembled");
  disturb(start);
  ConstraintObserver observer(visit);
  const RunOutcome end = Integration(mechanism, options, observer).run(start);
  if (end.status != RunStatus::kSucceeded) throw std::runtime_error("an integration of the validation failed: " + end.detail);
}

}  // namespace validation
