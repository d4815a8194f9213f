// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "engine/kinematics/joint_traits.h"

namespace engine {

/// Number of auxiliary joints, the coordinates of an actuator: the last joints, which turn about an axis of
/// the ground and carry nothing. They have no part in the motion of the bodies but by the applied forces.
template <std::size_t n>
[[nodiscard]] consteval std::size_t count_auxiliaries(const std::array<JointTraits, n>& joints) {
  std::size_t count = 0;
  while (count < n && joints[n - 1 - count].parent < 0 && joints[n - 1 - count].rotates()) ++count;
  return count;
}

/// The rotation coordinates of a static topology but auxiliary ones, in the order in which their sines are
/// computed: angles against springs, which stay small, behind the others.
template <std::size_t n>
struct JointAngles {
  std::array<std::size_t, 3 * n> coordinate{};  ///< of each angle
  std::array<std::size_t, n> first{};           ///< of each joint: its first angle
  std::size_t count = 0;
};
template <std::size_t n>
[[nodiscard]] consteval JointAngles<n> joint_angles(const std::array<JointTraits, n>& joints) {
  JointAngles<n> angles;
  for (const bool sprung : {false, true})
    for (std::size_t i = 0; i < n - count_auxiliaries(joints); ++i) {
      if (!joints[i].rotates() || joints[i].sprung != sprung) continue;
      angles.first[i] = angles.count;
      for (int k = 0; k < joints[i].count(); ++k)
        angles.coordinate[angles.count++] = static_cast<std::size_t>(joints[i].first + k);
    }
  return angles;
}

}  // namespace engine
