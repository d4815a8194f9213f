// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/support/cases.h"

#include <stdexcept>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"

namespace bench {

namespace {

constexpr double kPenetration = 5e-6;  // [m]; of a light impact

engine::Evaluation close_loop(const engine::Mechanism& mechanism) {
  engine::Evaluation assembled = engine::MotionSystem(mechanism).make_evaluation();
  if (!engine::LoopClosure(mechanism).assemble(0.0, assembled))
    throw std::runtime_error("the loop does not close");
  return assembled;
}

}  // namespace

engine::RpsupParameters linkage(engine::Coupler coupler, double c_r, double omega) {
  engine::RpsupParameters parameters;
  parameters.coupler = coupler;
  parameters.c_r = c_r;
  parameters.crank_velocity = omega;
  return parameters;
}

Coordinates assemble(const engine::Mechanism& mechanism) {
  const engine::Evaluation assembled = close_loop(mechanism);
  return {assembled.q, Eigen::VectorXd::Zero(assembled.q.size())};
}

Coordinates assemble_in_contact(const engine::RpsupParameters& parameters, const engine::Rpsup& rpsup) {
  const engine::Evaluation assembled = close_loop(rpsup.mechanism);
  Coordinates at{assembled.q, Eigen::VectorXd::Zero(assembled.q.size())};
  const engine::CutJoint& joint = rpsup.mechanism.cut_joints.at(0);
  const auto frame = [&](engine::FrameIndex i) -> const engine::FrameMotion& {
    return assembled.frames[static_cast<std::size_t>(i)];
  };
  const Eigen::Vector3d guide = frame(rpsup.layout.slider).R.col(0);
  const Eigen::Vector3d axis = frame(joint.bearing_frame).R * joint.bearing.R.col(2);
  // of the slider's way: what leads from the bearing's axis to its bore
  const double across = guide.cross(axis).norm();
  if (parameters.c_r > 0.0) at.q[rpsup.layout.slider] += (parameters.c_r + kPenetration) / across;
  at.qd[rpsup.layout.slider] = 0.01;
  at.qd[rpsup.layout.slider + 1] = 1.0;  // the cross link's own turn
  return at;
}

}  // namespace bench
