// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "engine/clearance/clearance_parameters.h"
#include "engine/model/linkage.h"
#include "validation/engine_names.h"

namespace validation {

inline constexpr double kLooseMass = 0.5;                            // [kg]
inline constexpr double kSocketRadius = 30e-3, kSocketPlay = 10e-3;  // [m]
inline constexpr double kBallRadius = kSocketRadius - kSocketPlay;   // [m]
inline constexpr double kBlockHalf = 10e-3, kBlockLength = 40e-3;    // [m]
inline constexpr double kSlotPlay = 1e-3;                            // along x, along y twice that, [m]
inline constexpr double kStandardGravity = 9.81;                     // [m/s^2]

/// Start of the one freedom of a loose body: a place and a rate, [m] or [rad].
struct LooseStart {
  double place = 0.0, rate = 0.0;
};
/// Of all freedoms, slides along x, y and z, turns about z, y and x.
using LooseStarts = std::array<LooseStart, 6>;

/// A body that nothing holds but the surfaces of its joint with the ground, along z: a ball's moments are
/// those of a full sphere. Its coordinates are x, y, z, turn_z, turn_y and turn_x.
[[nodiscard]] inline Linkage make_loose_body(JointKind kind, const ClearanceParameters& clearance,
                                             const LooseStarts& starts, const Eigen::Vector3d& gravity) {
  const double moment = 0.4 * kLooseMass * kBallRadius * kBallRadius;
  Linkage linkage;
  linkage.bodies = {
      {.name = "body", .mass = kLooseMass, .inertia = moment * Eigen::Matrix3d::Identity().eval()}};
  LinkageJoint joint{.name = "joint", .kind = kind, .from = kGroundName, .to = "body", .placement = {}};
  constexpr std::array kNames{"x", "y", "z", "turn_z", "turn_y", "turn_x"};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    joint.freedoms.push_back({.name = kNames[i], .start = starts[i].place, .start_rate = starts[i].rate});
  joint.clearance = clearance;
  linkage.joints = {joint};
  linkage.gravity_W = gravity;
  return linkage;
}

/// A ball in its socket, without friction and losses.
[[nodiscard]] inline ClearanceParameters make_socket() {
  ClearanceParameters socket;
  socket.geometry = ContactGeometry::kBallInSocket;
  socket.r_b = kSocketRadius;
  socket.c_r = kSocketPlay;
  socket.c_a = std::numeric_limits<double>::infinity();
  socket.K = 1e10;
  socket.chi = 0.0;
  return socket;
}

/// A block in its slot, the same.
[[nodiscard]] inline ClearanceParameters make_slot() {
  ClearanceParameters slot = make_socket();
  slot.geometry = ContactGeometry::kBlockInSlot;
  slot.block_x = slot.block_y = kBlockHalf;
  slot.L_b = kBlockLength;
  slot.c_r = kSlotPlay;
  slot.c_y = 2.0 * kSlotPlay;
  slot.K = 1e9;
  return slot;
}

/// LuGre's law with bristles so stiff that they hardly give, and one coefficient.
[[nodiscard]] inline FrictionParameters make_stiff_friction(double mu) {
  return {.mu_s = mu, .mu_k = mu, .sigma_0 = 1e6, .sigma_1 = 300.0};
}

}  // namespace validation
