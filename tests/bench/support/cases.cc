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

Coordinates assemble(const engine::Mechanism& mechanism) {
  engine::Evaluation assembled = engine::MotionSystem(mechanism).make_evaluation();
  if (!engine::LoopClosure(mechanism).assemble(0.0, assembled)) throw std::runtime_error("the loop does not close");
  return {assembled.q, Eigen::VectorXd::Zero(assembled.q.size())};
}

Coordinates assemble_in_contact(const engine::RpsupParameters& parameters, const engine::Rpsup& rpsup) {
  Coordinates at = assemble(rpsup.mechanism);
  const Eigen::Index psi = rpsup.layout.rod + 1;  // the coupler's first turn, about z: across the bearing
  const double lever = at.q[rpsup.layout.slider] - parameters.rod_length;  // the coupler's length seen along that axis
  if (parameters.c_r > 0.0) at.q[psi] += (parameters.c_r + kPenetration) / lever;
  at.qd[psi] = 0.02;
  at.qd[rpsup.layout.slider + 1] = 1.0;  // the cross link's own turn
  return at;
}

}  // namespace bench
