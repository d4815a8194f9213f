// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace engine {

/// A joint of a tree and the body that it carries, without their numbers: one coordinate, or the three rotations z, y, x of a spherical
/// joint taken together. What does not move, turn or weigh is marked, and left out where it is computed.
struct JointShape {
  enum class Kind { kTranslation, kRotation, kSpherical };
  enum class Inertia { kNone, kAxisymmetric, kDiagonal, kFull };  ///< kAxisymmetric: about the frame's x

  Kind kind = Kind::kRotation;
  int first = 0;                        ///< its coordinate, or the first of its three
  int axis = 0;                         ///< of a single coordinate: 0, 1, 2 for x, y, z
  int parent = -1;                      ///< joint that carries it
  bool driven = false;                  ///< its motion is given: the coordinate is eliminated
  int drive = -1;                       ///< by which drive
  bool turned = false;                  ///< its axes are not those of the parent's frame
  bool shifted = false;                 ///< it is not at the origin of the parent's frame
  bool shifted_along_x = false;         ///< and if so, along x alone
  bool sprung = false;                  ///< a spring or damper acts on it
  Inertia inertia = Inertia::kNone;
  bool com_at_origin = true;
  bool com_along_x = true;

  // What follows, by complete_shapes().
  int first_free = 0;                   ///< how many free coordinates stand before its own
  bool parent_turns = false;            ///< its parent's frame may rotate
  bool turns = false;                   ///< its own frame may
  bool moves = false;                   ///< it, or a joint that carries it, is free
  bool parent_moves = false;
  bool parent_answers_turning = false;  ///< a joint that carries it is a rotation: moments matter, of a driven one to its drive
  bool answers_turning = false;         ///< it is one, or a joint that carries it
  bool carries_moving = false;          ///< it carries joints that move
  bool last_child = false;              ///< of those that its parent carries and that move
  bool is_rod = false;                  ///< it turns a rod about one end that carries nothing which moves, or one spherical joint along it
  bool parent_is_rod = false;

  [[nodiscard]] constexpr int count() const { return kind == Kind::kSpherical ? 3 : 1; }
  [[nodiscard]] constexpr bool rotates() const { return kind != Kind::kTranslation; }

  /// Inlined everywhere: an out-of-line copy compiled for AVX-512 might be linked into code for other processors.
  [[gnu::always_inline]] constexpr bool operator==(const JointShape&) const = default;
};

/// Sets what follows from the other members. @param shapes  each behind the one that carries it
template <typename Shapes>
constexpr void complete_shapes(Shapes& shapes) {
  int first = 0, first_free = 0;
  for (auto& shape : shapes) {
    shape.first = first;
    first += shape.count();
    shape.first_free = first_free;
    if (!shape.driven) first_free += shape.count();
    if (shape.parent >= 0) {
      const auto& parent = shapes[static_cast<std::size_t>(shape.parent)];
      shape.parent_turns = parent.turns;
      shape.parent_moves = parent.moves;
      shape.parent_answers_turning = parent.answers_turning;
    }
    shape.turns = shape.parent_turns || shape.rotates();
    shape.moves = shape.parent_moves || !shape.driven;
    shape.answers_turning = shape.parent_answers_turning || shape.rotates();
    shape.is_rod = shape.kind == JointShape::Kind::kSpherical && shape.inertia == JointShape::Inertia::kAxisymmetric && shape.com_along_x;
  }
  for (std::size_t i = shapes.size(); i-- > 0;) {
    auto& shape = shapes[i];
    if (shape.parent < 0 || !shape.moves) continue;
    auto& parent = shapes[static_cast<std::size_t>(shape.parent)];
    shape.last_child = !parent.carries_moving;
    parent.carries_moving = true;
    const bool at_a_rods_end = shape.kind == JointShape::Kind::kSpherical && (!shape.shifted || shape.shifted_along_x);
    parent.is_rod = parent.is_rod && shape.last_child && at_a_rods_end;
  }
  for (auto& shape : shapes) shape.parent_is_rod = shape.parent >= 0 && shapes[static_cast<std::size_t>(shape.parent)].is_rod;
}

}  // namespace engine
