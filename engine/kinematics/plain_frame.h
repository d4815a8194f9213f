#pragma once

#include <Eigen/Core>

#include "engine/kinematics/frame_motion.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

// Between the vectors of the equations of motion, in plain numbers, and Eigen's.

[[nodiscard]] inline Vec3<double> to_vec3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
[[nodiscard]] inline Eigen::Vector3d to_eigen(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

[[nodiscard]] inline Mat3<double> to_mat3(const Eigen::Matrix3d& m) { return {to_vec3(m.col(0)), to_vec3(m.col(1)), to_vec3(m.col(2))}; }

[[nodiscard]] inline Frame<double, double> to_frame(const FrameMotion& f) {
  return {to_mat3(f.R), to_vec3(f.p), to_vec3(f.w), to_vec3(f.v), to_vec3(f.wd), to_vec3(f.vd)};
}

/// Leaves p_parent and axis as they are.
inline void set_motion(const Frame<double, double>& from, FrameMotion& f) {
  f.R.col(0) = to_eigen(from.R.x);
  f.R.col(1) = to_eigen(from.R.y);
  f.R.col(2) = to_eigen(from.R.z);
  f.p = to_eigen(from.p);
  f.w = to_eigen(from.w);
  f.v = to_eigen(from.v);
  f.wd = to_eigen(from.wd);
  f.vd = to_eigen(from.vd);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
