// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/math/dual.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A vector with its derivatives.
template <int count>
[[nodiscard]] RPSUP_INLINE Vec3<DualOf<count>> join(const Vec3<double>& v, const Vec3<LaneBlock<count>>& d) {
  return {{v.x, d.x}, {v.y, d.y}, {v.z, d.z}};
}
template <int count>
[[nodiscard]] RPSUP_INLINE Vec3<double> values_of(const Vec3<DualOf<count>>& v) {
  return {v.x.value, v.y.value, v.z.value};
}
template <int count>
[[nodiscard]] RPSUP_INLINE Vec3<LaneBlock<count>> derivatives_of(const Vec3<DualOf<count>>& v) {
  return {v.x.d, v.y.d, v.z.d};
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
