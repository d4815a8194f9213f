// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/energies.h"

#include <cstddef>

#include <Eigen/Geometry>

#include "engine/dynamics/spring_motion.h"

namespace engine {

namespace {

double calc_twice_kinetic_energy(const Coordinate& body, const FrameMotion& f) {
  const Eigen::Vector3d w_F = f.R.transpose() * f.w;
  const Eigen::Vector3d v_F = f.R.transpose() * f.v;
  return body.mass * (v_F.squaredNorm() + 2.0 * v_F.dot(w_F.cross(body.com))) + w_F.dot(body.inertia * w_F);
}

}  // namespace

double calc_kinetic_energy(const Mechanism& mechanism, const std::vector<FrameMotion>& frames,
                           const Eigen::VectorXd& qd) {
  double twice = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Coordinate& body = mechanism.coordinates[i];
    if (body.armature != 0.0) {
      const double rate = qd[static_cast<Eigen::Index>(i)];
      twice += body.armature * rate * rate;
    }
    if (body.mass == 0.0 || body.role == CoordinateRole::kMemory) continue;
    twice += calc_twice_kinetic_energy(body, frames[i]);
  }
  return 0.5 * twice;
}

double calc_potential_energy(const Mechanism& mechanism, const std::vector<FrameMotion>& frames,
                             const Eigen::VectorXd& q) {
  double energy = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Coordinate& c = mechanism.coordinates[i];
    const double qi = q[static_cast<Eigen::Index>(i)];
    energy += 0.5 * c.stiffness * qi * qi;
    if (c.mass > 0.0) energy -= c.mass * mechanism.gravity_W.dot(frames[i].p + frames[i].R * c.com);
  }
  for (const PointSpring& spring : mechanism.springs) {
    const double stretch = calc_spring_motion(spring, frames).length - spring.free_length;
    energy += 0.5 * spring.stiffness * stretch * stretch;
  }
  return energy;
}

}  // namespace engine
