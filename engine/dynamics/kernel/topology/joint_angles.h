// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "engine/kinematics/joint_traits.h"

namespace engine {

/// The angles of known joints: those against springs, which are small, behind the others.
template <std::size_t n>
struct Angles {
  std::array<std::size_t, 3 * n> coordinate{};
  std::array<std::size_t, n> place{};         ///< of each joint's first
  std::size_t count = 0;
};
template <std::size_t n>
[[nodiscard]] consteval Angles<n> angles_of(const std::array<JointShape, n>& shapes) {
  Angles<n> angles;
  for (const bool sprung : {false, true})
    for (std::size_t i = 0; i < n; ++i) {
      if (!shapes[i].rotates() || shapes[i].sprung != sprung) continue;
      angles.place[i] = angles.count;
      for (int k = 0; k < shapes[i].count(); ++k) angles.coordinate[angles.count++] = static_cast<std::size_t>(shapes[i].first + k);
    }
  return angles;
}

}  // namespace engine
