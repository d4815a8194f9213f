// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "engine/kinematics/frame_motion.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/math/vec3.h"
#include "engine/model/mechanism.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

// Between the vectors of the equations of motion, in plain numbers, and Eigen's.

[[nodiscard]] inline Vec3<double> to_vec3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
[[nodiscard]] inline Eigen::Vector3d to_eigen(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

[[nodiscard]] inline Mat3<double> to_mat3(const Eigen::Matrix3d& m) {
  return {to_vec3(m.col(0)), to_vec3(m.col(1)), to_vec3(m.col(2))};
}

[[nodiscard]] inline Frame<double, double> to_frame(const FrameMotion& f) {
  return {to_mat3(f.R), to_vec3(f.p), to_vec3(f.w), to_vec3(f.v), to_vec3(f.wd), to_vec3(f.vd)};
}

/// Number by number: a vector made of three that have just been written would be read by wider words, which
/// makes the processor wait.
inline void copy(const Vec3<double>& from, double* to) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

inline void copy(const Mat3<double>& from, double* to) {
  copy(from.x, to);
  copy(from.y, to + 3);
  copy(from.z, to + 6);
}

/// Moves a frame to a constant placement in it.
RPSUP_INLINE void move_to(const Placement& placement, Frame<double, double>& f) {
  shift_frame(f.R * to_vec3(placement.p), true, f);
  if (!is_unrotated(placement)) f.R = f.R * to_mat3(placement.R);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
