// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/model/mechanism.h"

namespace engine {

/// A double pendulum of two bodies: smooth, free, with an energy.
inline Mechanism make_pendulum() {
  Mechanism m;
  m.coordinates.push_back({.name = "angle", .placement = {}, .axis = Axis::kZ, .assembly_guess = 1.0, .mass = 2.0,
                           .com = {0.3, 0.0, 0.0}, .inertia = Eigen::Vector3d(0.01, 0.25, 0.25).asDiagonal()});
  m.coordinates.push_back({.name = "second", .parent = 0, .placement = {.p = {0.5, 0.0, 0.0}}, .axis = Axis::kZ, .assembly_guess = -0.5,
                           .mass = 1.0, .com = {0.2, 0.1, 0.0}, .inertia = Eigen::Vector3d(0.02, 0.06, 0.08).asDiagonal()});
  m.gravity_W = {0.0, -9.81, 0.0};
  return m;
}

}  // namespace engine
