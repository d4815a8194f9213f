// SPDX-License-Identifier: Apache-2.0
#include "engine/model/spherical_rotations.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace engine {

namespace {

/// @returns whether a frame has no mass and carries a single joint, no load, spring or closed loop
bool is_empty(const Mechanism& mechanism, FrameIndex i) {
  return mechanism.coordinates[static_cast<std::size_t>(i)].mass == 0.0 &&
         std::ranges::none_of(mechanism.cut_joints, [i](const CutJoint& joint) {
           return joint.bearing_frame == i || joint.journal_frame == i;
         }) &&
         std::ranges::none_of(mechanism.springs, [i](const PointSpring& spring) {
           return spring.from_frame == i || spring.to_frame == i;
         }) &&
         std::ranges::none_of(mechanism.body_loads, [i](const BodyLoad& load) { return load.frame == i; }) &&
         std::ranges::count(mechanism.coordinates, i, &Coordinate::parent) == 1;
}

}  // namespace

bool are_spherical_rotations(const Mechanism& mechanism, FrameIndex psi) {
  constexpr std::array kAxes{Axis::kZ, Axis::kY, Axis::kX};
  if (static_cast<std::size_t>(psi) + kAxes.size() > mechanism.coordinates.size()) return false;
  for (int k = 0; k < static_cast<int>(kAxes.size()); ++k) {
    const Coordinate& c = mechanism.coordinates[static_cast<std::size_t>(psi + k)];
    if (c.motion != Motion::kRotation || c.axis != kAxes[static_cast<std::size_t>(k)]) return false;
    if (k == 0) continue;
    if (c.parent != psi + k - 1 || !is_inside_joint(c) || !is_unrotated(c.placement) ||
        !is_empty(mechanism, psi + k - 1))
      return false;
  }
  return true;
}

}  // namespace engine
