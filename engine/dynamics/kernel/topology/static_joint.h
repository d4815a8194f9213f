// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "engine/kinematics/joint_traits.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A joint whose shape is known when the program is compiled: what it leaves out costs not even a question.
template <const auto& shapes, std::size_t index>
struct KnownJoint {
  static constexpr JointShape shape = shapes[index];
  static constexpr JointShape::Kind kind = shape.kind;
  static constexpr int first = shape.first;
  static constexpr int axis = shape.axis;
  static constexpr int parent = shape.parent;
  static constexpr bool driven = shape.driven;
  static constexpr int drive = shape.drive;
  static constexpr int first_free = shape.first_free;
  static constexpr bool turned = shape.turned;
  static constexpr bool shifted = shape.shifted;
  static constexpr bool shifted_along_x = shape.shifted_along_x;
  static constexpr bool sprung = shape.sprung;
  static constexpr JointShape::Inertia inertia = shape.inertia;
  static constexpr bool com_at_origin = shape.com_at_origin;
  static constexpr bool com_along_x = shape.com_along_x;
  static constexpr bool parent_turns = shape.parent_turns;
  static constexpr bool turns = shape.turns;
  static constexpr bool moves = shape.moves;
  static constexpr bool parent_moves = shape.parent_moves;
  static constexpr bool parent_answers_turning = shape.parent_answers_turning;
  static constexpr bool answers_turning = shape.answers_turning;
  static constexpr bool carries_moving = shape.carries_moving;
  static constexpr bool last_child = shape.last_child;
  static constexpr bool is_rod = shape.is_rod;
  static constexpr bool parent_is_rod = shape.parent_is_rod;

  [[nodiscard]] static constexpr int count() { return shape.count(); }
  [[nodiscard]] static constexpr bool rotates() { return shape.rotates(); }
  [[nodiscard]] RPSUP_INLINE const TreeJoint& numbers() const { return joint; }

  const TreeJoint& joint;
};

/// Joints from the first up to the end.
struct Series {
  std::size_t first = 0, end = 0;
};
/// The first rods alike of which each stands on the one before it; empty where there are no two of them.
template <std::size_t n>
[[nodiscard]] consteval Series find_series(const std::array<JointShape, n>& shapes) {
  const auto follows = [&](std::size_t i) {
    JointShape before = shapes[i - 1];
    before.first = shapes[i].first;
    before.first_free = shapes[i].first_free;
    before.parent = static_cast<int>(i) - 1;
    before.carries_moving = shapes[i].carries_moving;
    return shapes[i].is_rod && shapes[i] == before && shapes[i - 1].parent + 2 == static_cast<int>(i);
  };
  for (std::size_t i = 1; i < n; ++i) {
    if (!follows(i)) continue;
    std::size_t end = i + 1;
    while (end < n && follows(end)) ++end;
    return {i - 1, end};
  }
  return {};
}

/// One of several rods in series, alike but for the coordinates and the parent, and for what the last one lacks. A loop over them is less code than
/// each for itself, and what does not fit into the processor's cache of instructions is fetched again for each evaluation.
/// @tparam index  of the first one
template <const auto& shapes, std::size_t index>
struct RodInSeries : KnownJoint<shapes, index> {
  /// @param behind  how many stand before it
  RPSUP_INLINE RodInSeries(const TreeJoint& of, std::size_t behind)
      : KnownJoint<shapes, index>{of},
        first(shapes[index].first + 3 * static_cast<int>(behind)),
        first_free(shapes[index].first_free + 3 * static_cast<int>(behind)),
        parent(shapes[index].parent + static_cast<int>(behind)),
        carries_moving(index + behind + 1 < end || shapes[end - 1].carries_moving),
        from_first(3 * behind) {}

  static constexpr std::size_t end = find_series(shapes).end;
  int first, first_free, parent;
  bool carries_moving;
  std::size_t from_first;  ///< coordinates between its own and those of the first one
};

/// A joint's coordinates: visit(k). Known ones are no loop, so that what they index may stay in registers.
template <typename Visit>
RPSUP_INLINE void each_coordinate(const TreeJoint& joint, const Visit& visit) {
  for (int k = 0; k < joint.count(); ++k) visit(k);
}
template <const auto& shapes, std::size_t index, typename Visit>
RPSUP_INLINE void each_coordinate(const KnownJoint<shapes, index>&, const Visit& visit) {
  visit(0);
  if constexpr (KnownJoint<shapes, index>::count() == 3) {
    visit(1);
    visit(2);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
