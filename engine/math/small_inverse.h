// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/math/complex.h"
#include "engine/math/finite.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Inverse of a matrix of n = 1 or 3. False if it is singular.
template <typename Scalar>
[[nodiscard]] bool invert_small(int n, const Scalar (&m)[3][3], Scalar (&inverse)[3][3]) {
  if (n == 1) {
    inverse[0][0] = 1.0 / m[0][0];
    return is_number(size_of(inverse[0][0]));
  }
  const Vec3<Scalar> x{m[0][0], m[0][1], m[0][2]}, y{m[1][0], m[1][1], m[1][2]}, z{m[2][0], m[2][1], m[2][2]};
  const Vec3<Scalar> columns[3] = {cross(y, z), cross(z, x), cross(x, y)};
  const Scalar by = 1.0 / dot(x, columns[0]);
  for (int k = 0; k < 3; ++k) {
    inverse[0][k] = by * columns[k].x;
    inverse[1][k] = by * columns[k].y;
    inverse[2][k] = by * columns[k].z;
  }
  return is_number(size_of(by));
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
