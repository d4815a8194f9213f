#pragma once

#include <Eigen/Core>

namespace engine {

/// R <- R Rot(axis, angle) for a coordinate axis: only the two columns beside it change.
/// @param axis  0, 1, 2 for x, y, z
inline void rotate_about_own_axis(int axis, double sine, double cosine, Eigen::Matrix3d& R) {
  const int i = (axis + 1) % 3;
  const int j = (axis + 2) % 3;
  const Eigen::Vector3d column_i = R.col(i);
  R.col(i) = cosine * column_i + sine * R.col(j);
  R.col(j) = cosine * R.col(j) - sine * column_i;
}

}  // namespace engine
