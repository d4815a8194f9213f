#include "engine/kinematics/frame_motion.h"

#include <cstddef>

#include "engine/kinematics/plain_frame.h"

namespace engine {

namespace {

/// Moves a frame that turns with its body to a constant placement. @returns the way from the body's origin
Vec3<double> place(const Placement& placement, Frame<double, double>& f) {
  const Vec3<double> r = f.R * to_vec3(placement.p);
  shift_frame(r, true, f);
  if (!is_unturned(placement)) f.R = f.R * to_mat3(placement.R);
  return r;
}

}  // namespace

FrameMotion ground_motion(const Mechanism& mechanism) {
  FrameMotion ground;
  ground.vd = -mechanism.gravity_W;
  return ground;
}

FrameMotion calc_placed_motion(const FrameMotion& frame, const Placement& placement) {
  Frame<double, double> f = to_frame(frame);
  (void)place(placement, f);
  FrameMotion placed = frame;
  set_motion(f, placed);
  return placed;
}

void calc_frame_motions(const Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                        std::vector<FrameMotion>& frames) {
  const FrameMotion ground = ground_motion(mechanism);
  for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i) {
    const Coordinate& c = mechanism.coordinates[i];
    const auto k = static_cast<Eigen::Index>(i);
    const int axis = static_cast<int>(c.axis);
    Frame<double, double> f = to_frame(c.parent == kGround ? ground : frames[static_cast<std::size_t>(c.parent)]);
    Vec3<double> r, along;
    if (!is_inside_joint(c) || !is_unturned(c.placement)) r = place(c.placement, f);
    if (c.motion == Motion::kTranslation) {
      along = axis_of(f.R, axis);
      slide_frame(along, true, q[k], qd[k], f, r);
      f.vd += qdd[k] * along;
    } else {
      turn_frame(axis, true, calc_turn(q[k]), qd[k], f, along);
      f.wd += qdd[k] * along;
    }
    set_motion(f, frames[i]);
    frames[i].p_parent = to_eigen(r);
    frames[i].axis = to_eigen(along);
  }
}

}  // namespace engine
