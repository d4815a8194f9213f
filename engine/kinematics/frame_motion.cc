#include "engine/kinematics/frame_motion.h"

#include <cmath>
#include <cstddef>

#include "engine/math/axis_rotation.h"

namespace engine {

FrameMotion ground_motion(const Mechanism& mechanism) {
  FrameMotion ground;
  ground.vd = -mechanism.gravity_W;
  return ground;
}

FrameMotion calc_placed_motion(const FrameMotion& frame, const Placement& placement) {
  FrameMotion placed = frame;
  const Eigen::Vector3d r = frame.R * placement.p;
  placed.R = frame.R * placement.R;
  placed.p = frame.p + r;
  placed.v = frame.v + frame.w.cross(r);
  placed.vd = frame.vd + frame.wd.cross(r) + frame.w.cross(frame.w.cross(r));
  return placed;
}

void calc_frame_motions(const Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                        std::vector<FrameMotion>& frames) {
  const FrameMotion ground = ground_motion(mechanism);
  for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i) {
    const Coordinate& c = mechanism.coordinates[i];
    const auto k = static_cast<Eigen::Index>(i);
    const FrameMotion& parent = c.parent == kGround ? ground : frames[static_cast<std::size_t>(c.parent)];
    FrameMotion& f = frames[i];
    f.R.noalias() = parent.R * c.placement.R;
    f.axis = f.R.col(static_cast<int>(c.axis));
    f.p_parent.noalias() = parent.R * c.placement.p;
    f.w = parent.w;
    f.wd = parent.wd;
    if (c.motion == Motion::kRotation) {
      rotate_about_own_axis(static_cast<int>(c.axis), std::sin(q[k]), std::cos(q[k]), f.R);
      f.w += f.axis * qd[k];
      f.wd += parent.w.cross(f.axis) * qd[k] + f.axis * qdd[k];
      f.v = parent.v + parent.w.cross(f.p_parent);
      f.vd = parent.vd + parent.wd.cross(f.p_parent) + parent.w.cross(parent.w.cross(f.p_parent));
    } else {
      f.p_parent += f.axis * q[k];
      f.v = parent.v + parent.w.cross(f.p_parent) + f.axis * qd[k];
      f.vd = parent.vd + parent.wd.cross(f.p_parent) + parent.w.cross(parent.w.cross(f.p_parent) + 2.0 * qd[k] * f.axis) + f.axis * qdd[k];
    }
    f.p = parent.p + f.p_parent;
  }
}

JacobianColumn calc_jacobian_column(const Coordinate& coordinate, const FrameMotion& frame, const Eigen::Vector3d& p_W) {
  if (coordinate.motion == Motion::kTranslation) return {frame.axis, Eigen::Vector3d::Zero()};
  return {frame.axis.cross(p_W - frame.p), frame.axis};
}

}  // namespace engine
