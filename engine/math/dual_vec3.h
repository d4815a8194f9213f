#pragma once

#include "engine/math/dual.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A vector with its derivatives.
[[nodiscard]] RPSUP_INLINE Vec3<Dual> join(const Vec3<double>& v, const Vec3<Lanes>& d) { return {{v.x, d.x}, {v.y, d.y}, {v.z, d.z}}; }
[[nodiscard]] RPSUP_INLINE Vec3<double> values_of(const Vec3<Dual>& v) { return {v.x.value, v.y.value, v.z.value}; }
[[nodiscard]] RPSUP_INLINE Vec3<Lanes> derivatives_of(const Vec3<Dual>& v) { return {v.x.d, v.y.d, v.z.d}; }

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
