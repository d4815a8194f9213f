#include "engine/kinematics/frame_motion.h"

#include <cmath>
#include <cstddef>

#include "engine/kinematics/plain_frame.h"

namespace engine {

FrameMotion ground_motion(const Mechanism& mechanism) {
  FrameMotion ground;
  ground.vd = -mechanism.gravity_W;
  return ground;
}

void calc_frame_motions(const Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                        std::vector<FrameMotion>& frames) {
  const Frame<double, double> ground = to_frame(ground_motion(mechanism));
  Frame<double, double> f = ground;
  for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i) {
    const Coordinate& c = mechanism.coordinates[i];
    const auto k = static_cast<Eigen::Index>(i);
    const int axis = static_cast<int>(c.axis);
    if (c.parent == kGround)
      f = ground;
    else if (c.parent + 1 != static_cast<FrameIndex>(i))  // else f is the parent's
      f = to_frame(frames[static_cast<std::size_t>(c.parent)]);
    Vec3<double> r, along;
    if (!is_inside_joint(c) || !is_unturned(c.placement)) r = move_to(c.placement, f);
    if (c.motion == Motion::kTranslation) {
      along = axis_of(f.R, axis);
      slide_frame(along, true, q[k], qd[k], f, r);
      f.vd += qdd[k] * along;
    } else {
      turn_frame(axis, true, {std::sin(q[k]), std::cos(q[k])}, qd[k], f, along);
      f.wd += qdd[k] * along;
    }
    set_motion(f, frames[i]);
    copy(r, frames[i].p_parent.data());
    copy(along, frames[i].axis.data());
  }
}

}  // namespace engine
