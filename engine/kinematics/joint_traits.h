// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace engine {

/// Traits of a joint and of the body that it carries: everything but their numbers. A joint has one
/// coordinate, or is a spherical joint with the three rotations about z, y, x. The equations of motion leave
/// out what the traits mark as zero or fixed.
struct JointTraits {
  enum class Kind { kTranslation, kRotation, kSpherical };
  enum class Inertia { kNone, kAxisymmetric, kDiagonal, kFull };  ///< kAxisymmetric: about the frame's x

  Kind kind = Kind::kRotation;
  int first = 0;                        ///< index of its coordinate, or of the first of its three
  int axis = 0;                         ///< of a single coordinate: 0, 1, 2 for x, y, z
  int parent = -1;                      ///< the joint whose body carries this one; -1: the ground
  bool driven = false;                  ///< its motion is given
  int drive = -1;                       ///< index of the drive that gives it
  bool rotated = false;                 ///< its axes are not parallel to those of the parent's frame
  bool shifted = false;                 ///< it is not at the origin of the parent's frame
  bool shifted_along_x = false;         ///< the shift has an x component only
  bool sprung = false;                  ///< a spring or damper acts on it
  bool has_armature = false;            ///< a rotor is geared to it
  Inertia inertia = Inertia::kNone;
  bool com_at_origin = true;
  bool com_along_x = true;

  // Set by complete_traits():
  int first_free = 0;                   ///< number of free coordinates before its own
  bool parent_frame_rotates = false;    ///< the parent's frame may rotate
  bool frame_rotates = false;           ///< its own frame may rotate
  bool moves = false;                   ///< it, or a joint between it and the ground, is free
  bool parent_moves = false;
  /// a joint between it and the ground is a rotation: the moment on the parent does work there
  bool parent_moment_matters = false;
  bool moment_matters = false;          ///< the same, its own rotation included
  bool has_moving_children = false;     ///< its body carries joints that move
  bool last_child = false;              ///< the last one of the parent's moving children
  bool is_slender = false;  ///< a spherical joint at one end of a slender body: see SlenderBodyMotion
  bool parent_is_slender = false;

  [[nodiscard]] constexpr int count() const { return kind == Kind::kSpherical ? 3 : 1; }
  [[nodiscard]] constexpr bool rotates() const { return kind != Kind::kTranslation; }

  /// Inlined everywhere: an out-of-line copy compiled for AVX-512 might be linked into code for other
  /// processors.
  [[gnu::always_inline]] constexpr bool operator==(const JointTraits&) const = default;
};

/// Sets the traits that follow from the others.
///
/// A body is slender if it is axisymmetric about x, rotates in a spherical joint, and carries nothing that
/// moves, or one spherical joint on its x axis. So a slender body has at most one moving child.
/// @param joints  each behind its parent
template <typename Joints>
constexpr void complete_traits(Joints& joints) {
  int first = 0, first_free = 0;
  for (auto& joint : joints) {
    joint.first = first;
    first += joint.count();
    joint.first_free = first_free;
    if (!joint.driven) first_free += joint.count();
    if (joint.parent >= 0) {
      const auto& parent = joints[static_cast<std::size_t>(joint.parent)];
      joint.parent_frame_rotates = parent.frame_rotates;
      joint.parent_moves = parent.moves;
      joint.parent_moment_matters = parent.moment_matters;
    }
    joint.frame_rotates = joint.parent_frame_rotates || joint.rotates();
    joint.moves = joint.parent_moves || !joint.driven;
    joint.moment_matters = joint.parent_moment_matters || joint.rotates();
    joint.is_slender = joint.kind == JointTraits::Kind::kSpherical &&
                       joint.inertia == JointTraits::Inertia::kAxisymmetric && joint.com_along_x;
  }
  for (std::size_t i = joints.size(); i-- > 0;) {
    auto& joint = joints[i];
    if (joint.parent < 0 || !joint.moves) continue;
    auto& parent = joints[static_cast<std::size_t>(joint.parent)];
    joint.last_child = !parent.has_moving_children;
    parent.has_moving_children = true;
    const bool on_the_x_axis =
        joint.kind == JointTraits::Kind::kSpherical && (!joint.shifted || joint.shifted_along_x);
    parent.is_slender = parent.is_slender && joint.last_child && on_the_x_axis;
  }
  for (auto& joint : joints)
    joint.parent_is_slender = joint.parent >= 0 && joints[static_cast<std::size_t>(joint.parent)].is_slender;
}

}  // namespace engine
