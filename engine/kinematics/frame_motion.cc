// SPDX-License-Identifier: Apache-2.0
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

void calc_frame_poses(const Mechanism& mechanism, const Eigen::VectorXd& q,
                      std::vector<FrameMotion>& frames) {
  const Mat3<double> identity = to_mat3(Eigen::Matrix3d::Identity());
  Mat3<double> R = identity;
  Vec3<double> p;
  for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i) {
    const Coordinate& c = mechanism.coordinates[i];
    const double q_i = q[static_cast<Eigen::Index>(i)];
    if (c.parent == kGround) {
      R = identity;
      p = {};
    } else if (c.parent + 1 != static_cast<FrameIndex>(i)) {  // else they are the parent's
      R = to_mat3(frames[static_cast<std::size_t>(c.parent)].R);
      p = to_vec3(frames[static_cast<std::size_t>(c.parent)].p);
    }
    Vec3<double> r, along;
    if (!is_inside_joint(c)) r = R * to_vec3(c.placement.p);
    if (!is_unrotated(c.placement)) R = R * to_mat3(c.placement.R);
    if (c.motion == Motion::kTranslation) {
      along = axis_of(R, static_cast<int>(c.axis));
      r += q_i * along;
    } else {
      along = rotate_axes(static_cast<int>(c.axis), {std::sin(q_i), std::cos(q_i)}, R);
    }
    p += r;
    FrameMotion& f = frames[i];
    copy(R, f.R.data());
    copy(p, f.p.data());
    copy(r, f.p_parent.data());
    copy(along, f.axis.data());
  }
}

void calc_frame_rates(const Mechanism& mechanism, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                      std::vector<FrameMotion>& frames) {
  const Frame<double, double> ground = to_frame(ground_motion(mechanism));
  Frame<double, double> f = ground;
  for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i) {
    const Coordinate& c = mechanism.coordinates[i];
    const auto k = static_cast<Eigen::Index>(i);
    if (c.parent == kGround)
      f = ground;
    else if (c.parent + 1 != static_cast<FrameIndex>(i))  // else f is the parent's
      f = to_frame(frames[static_cast<std::size_t>(c.parent)]);
    FrameMotion& motion = frames[i];
    const Vec3<double> along = to_vec3(motion.axis);
    shift_frame(to_vec3(motion.p_parent), true, f);
    if (c.motion == Motion::kTranslation) {
      add_translation_rate(along, true, qd[k], f);
      f.vd += qdd[k] * along;
    } else {
      add_rotation_rate(along, true, qd[k], f);
      f.wd += qdd[k] * along;
    }
    copy(f.w, motion.w.data());
    copy(f.v, motion.v.data());
    copy(f.wd, motion.wd.data());
    copy(f.vd, motion.vd.data());
  }
}

void calc_frame_motions(const Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                        const Eigen::VectorXd& qdd, std::vector<FrameMotion>& frames) {
  calc_frame_poses(mechanism, q, frames);
  calc_frame_rates(mechanism, qd, qdd, frames);
}

}  // namespace engine
