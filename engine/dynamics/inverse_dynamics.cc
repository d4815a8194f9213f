// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/inverse_dynamics.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/Geometry>

#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/plain_frame.h"

namespace engine {

InverseDynamics::InverseDynamics(const Mechanism& mechanism)
    : model_(make_given_model(mechanism)), loads_(model_.joints.size()), transmitted_(model_.joints.size()) {
  forces_.setZero(model_.coordinates);
}

void InverseDynamics::add_load(FrameIndex frame, const Wrench& about_origin) {
  Wrench& load = loads_[static_cast<std::size_t>(frame)];
  load.force += about_origin.force;
  load.moment += about_origin.moment;
}

/// transmitted_ <- what each body's own motion takes, less its loads, which are cleared
void InverseDynamics::calc_net_forces(const std::vector<FrameMotion>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const SpatialForce<double> force = calc_newton_euler_force(model_.joints[i], to_frame(frames[i]));
    transmitted_[i] = {to_eigen(force.force) - loads_[i].force, to_eigen(force.moment) - loads_[i].moment};
  }
  std::fill(loads_.begin(), loads_.end(), Wrench{});
}

const Eigen::VectorXd& InverseDynamics::calc(const std::vector<FrameMotion>& frames) {
  calc_net_forces(frames);
  for (std::size_t i = frames.size(); i-- > 0;) {
    const TreeJoint& joint = model_.joints[i];
    const Wrench& force = transmitted_[i];
    const bool slides = joint.kind == TreeJoint::Kind::kTranslation;
    forces_[static_cast<Eigen::Index>(i)] = frames[i].axis.dot(slides ? force.force : force.moment);
    if (joint.parent < 0) continue;
    Wrench& parent = transmitted_[static_cast<std::size_t>(joint.parent)];
    parent.force += force.force;
    parent.moment += force.moment + frames[i].p_parent.cross(force.force);
  }
  return forces_;
}

}  // namespace engine
