#include "tests/bench/support/cases.h"

#include <stdexcept>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"

namespace bench {

namespace {

constexpr double kPenetration = 5e-6;  // [m]; of a light impact

}  // namespace

engine::RpsupParameters linkage(engine::Coupler coupler, double c_r, double omega) {
  engine::RpsupParameters parameters;
  parameters.coupler = coupler;
  parameters.c_r = c_r;
  parameters.crank_velocity = omega;
  return parameters;
}

Eigen::VectorXd assemble(const engine::Mechanism& mechanism) {
  engine::Evaluation assembled = engine::MotionSystem(mechanism).make_evaluation();
  if (!engine::LoopClosure(mechanism).assemble(0.0, assembled)) throw std::runtime_error("the loop does not close");
  return assembled.q;
}

Eigen::VectorXd assemble_in_contact(const engine::Rpsup& rpsup) {
  Eigen::VectorXd q = assemble(rpsup.mechanism);
  for (const engine::CutJoint& joint : rpsup.mechanism.cut_joints)
    if (joint.clearance) q[rpsup.layout.slider] += joint.clearance->c_r + kPenetration;
  return q;
}

}  // namespace bench
