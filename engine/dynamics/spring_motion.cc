// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/spring_motion.h"

#include <Eigen/Geometry>

namespace engine {

SpringMotion calc_spring_motion(const PointSpring& spring, const std::vector<FrameMotion>& frames) {
  const FrameMotion from = motion_of(spring.from_frame, frames), to = motion_of(spring.to_frame, frames);
  SpringMotion motion;
  motion.from = from.p + from.R * spring.from;
  motion.to = to.p + to.R * spring.to;
  const Eigen::Vector3d way = motion.to - motion.from;
  const Eigen::Vector3d v = to.v + to.w.cross(to.R * spring.to) - from.v - from.w.cross(from.R * spring.from);
  motion.length = way.norm();
  motion.force = -spring.drag * v;
  if (!(motion.length > 0.0)) return motion;
  motion.tension =
      spring.stiffness * (motion.length - spring.free_length) + spring.damping * way.dot(v) / motion.length;
  motion.force -= motion.tension / motion.length * way;
  return motion;
}

}  // namespace engine
