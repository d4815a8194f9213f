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

namespace {

/// Position, velocity and acceleration of a frame's origin, which its parent carries and a translation moves along the axis.
void move_origin(const Coordinate& c, const FrameMotion& parent, double q, double qd, double qdd, FrameMotion& f) {
  f.p_parent.noalias() = parent.R * c.placement.p;
  const bool slides = c.motion == Motion::kTranslation;
  if (slides) f.p_parent += f.axis * q;
  f.p = parent.p + f.p_parent;
  const Eigen::Vector3d carried = parent.w.cross(f.p_parent);
  f.v = parent.v + carried;
  f.vd = parent.vd + parent.wd.cross(f.p_parent) + parent.w.cross(carried);
  if (!slides) return;
  f.v += f.axis * qd;
  f.vd += 2.0 * qd * parent.w.cross(f.axis) + f.axis * qdd;
}

}  // namespace

void calc_frame_motions(const Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                        std::vector<FrameMotion>& frames) {
  const FrameMotion ground = ground_motion(mechanism);
  for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i) {
    const Coordinate& c = mechanism.coordinates[i];
    const auto k = static_cast<Eigen::Index>(i);
    const FrameMotion& parent = c.parent == kGround ? ground : frames[static_cast<std::size_t>(c.parent)];
    FrameMotion& f = frames[i];
    if (is_unturned(c.placement)) {
      f.R = parent.R;
    } else {
      f.R.noalias() = parent.R * c.placement.R;
    }
    f.axis = f.R.col(static_cast<int>(c.axis));
    if (is_inside_joint(c)) {
      f.p_parent.setZero();
      f.p = parent.p;
      f.v = parent.v;
      f.vd = parent.vd;
    } else {
      move_origin(c, parent, q[k], qd[k], qdd[k], f);
    }
    if (c.motion == Motion::kRotation) {
      rotate_about_own_axis(static_cast<int>(c.axis), std::sin(q[k]), std::cos(q[k]), f.R);
      f.w = parent.w + f.axis * qd[k];
      f.wd = parent.wd + parent.w.cross(f.axis) * qd[k] + f.axis * qdd[k];
    } else {
      f.w = parent.w;
      f.wd = parent.wd;
    }
  }
}

JacobianColumn calc_jacobian_column(const Coordinate& coordinate, const FrameMotion& frame, const Eigen::Vector3d& p_W) {
  if (coordinate.motion == Motion::kTranslation) return {frame.axis, Eigen::Vector3d::Zero()};
  return {frame.axis.cross(p_W - frame.p), frame.axis};
}

}  // namespace engine
