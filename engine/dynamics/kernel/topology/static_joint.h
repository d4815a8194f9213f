// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "engine/kinematics/joint_traits.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A joint whose traits are compile-time constants, with the members of TreeJoint: branches on them cost
/// nothing.
/// @tparam joints  std::array of JointTraits  @tparam index  of this joint
template <const auto& joints, std::size_t index>
struct StaticJoint {
  static constexpr JointTraits traits = joints[index];
  static constexpr JointTraits::Kind kind = traits.kind;
  static constexpr JointTraits::Inertia inertia = traits.inertia;
  static constexpr int first = traits.first, first_free = traits.first_free, axis = traits.axis,
                       parent = traits.parent, drive = traits.drive;
  static constexpr bool driven = traits.driven, sprung = traits.sprung, has_armature = traits.has_armature;
  static constexpr bool rotated = traits.rotated, shifted = traits.shifted,
                        shifted_along_x = traits.shifted_along_x;
  static constexpr bool com_at_origin = traits.com_at_origin, com_along_x = traits.com_along_x;
  static constexpr bool frame_rotates = traits.frame_rotates,
                        parent_frame_rotates = traits.parent_frame_rotates;
  static constexpr bool moves = traits.moves, parent_moves = traits.parent_moves;
  static constexpr bool moment_matters = traits.moment_matters,
                        parent_moment_matters = traits.parent_moment_matters;
  static constexpr bool has_moving_children = traits.has_moving_children, last_child = traits.last_child;
  static constexpr bool is_slender = traits.is_slender, parent_is_slender = traits.parent_is_slender;

  [[nodiscard]] static constexpr int count() { return traits.count(); }
  [[nodiscard]] static constexpr bool rotates() { return traits.rotates(); }
  [[nodiscard]] RPSUP_INLINE const TreeJoint& data() const { return joint; }

  const TreeJoint& joint;
};

/// A range of joints, the last one excluded.
struct JointSeries {
  std::size_t first = 0, end = 0;
};
/// The first series of two or more equal slender bodies, each carrying the next. Empty if there is none.
template <std::size_t n>
[[nodiscard]] consteval JointSeries find_series(const std::array<JointTraits, n>& joints) {
  const auto continues_series = [&](std::size_t i) {
    JointTraits before = joints[i - 1];
    before.first = joints[i].first;
    before.first_free = joints[i].first_free;
    before.parent = static_cast<int>(i) - 1;
    before.has_moving_children = joints[i].has_moving_children;
    return joints[i].is_slender && joints[i] == before && joints[i - 1].parent + 2 == static_cast<int>(i);
  };
  for (std::size_t i = 1; i < n; ++i) {
    if (!continues_series(i)) continue;
    std::size_t end = i + 1;
    while (end < n && continues_series(end)) ++end;
    return {i - 1, end};
  }
  return {};
}

/// One of the slender bodies of a series, with its traits but for the indices and has_moving_children. A loop
/// over the series is less code than each joint for itself, and code that overflows the processor's
/// instruction cache is fetched again in each evaluation.
/// @tparam index  of the first one
template <const auto& joints, std::size_t index>
struct SlenderJointInSeries : StaticJoint<joints, index> {
  /// @param position  of this joint in the series, from 0
  RPSUP_INLINE SlenderJointInSeries(const TreeJoint& of, std::size_t position)
      : StaticJoint<joints, index>{of},
        first(joints[index].first + 3 * static_cast<int>(position)),
        first_free(joints[index].first_free + 3 * static_cast<int>(position)),
        parent(joints[index].parent + static_cast<int>(position)),
        has_moving_children(index + position + 1 < end || joints[end - 1].has_moving_children),
        from_first(3 * position) {}

  static constexpr std::size_t end = find_series(joints).end;
  int first, first_free, parent;
  bool has_moving_children;
  std::size_t from_first;  ///< coordinates between its own and those of the first one
};

/// Visits a joint's coordinates: visit(k). Those of a static joint are no loop, so that what they index may
/// stay in registers.
template <typename Visit>
RPSUP_INLINE void for_each_coordinate(const TreeJoint& joint, const Visit& visit) {
  for (int k = 0; k < joint.count(); ++k) visit(k);
}
template <const auto& joints, std::size_t index, typename Visit>
RPSUP_INLINE void for_each_coordinate(const StaticJoint<joints, index>&, const Visit& visit) {
  visit(0);
  if constexpr (StaticJoint<joints, index>::count() == 3) {
    visit(1);
    visit(2);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
