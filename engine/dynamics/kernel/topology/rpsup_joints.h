// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "engine/kinematics/joint_traits.h"
#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Joints of the paper's linkage with prescribed drives: crank, rod, coupler (in n_rfe parts), slider, cross
/// link. Their traits are to be completed.
/// @tparam yoke_axis  axis of the cross link's rotation: 0 along the guide, 1 across it
template <std::size_t n_rfe, int yoke_axis>
consteval std::array<JointTraits, n_rfe + 4> list_rpsup_joints() {
  using Kind = JointTraits::Kind;
  using Inertia = JointTraits::Inertia;
  std::array<JointTraits, n_rfe + 4> joints{};
  joints[0] = {.kind = Kind::kRotation, .axis = 2, .driven = true, .drive = 0, .shifted_along_x = true,
               .inertia = Inertia::kAxisymmetric, .com_at_origin = false};
  joints[1] = {.kind = Kind::kTranslation,
               .axis = 0,
               .parent = 0,
               .driven = true,
               .drive = 1,
               .shifted_along_x = true,
               .inertia = Inertia::kAxisymmetric,
               .com_at_origin = false};
  for (std::size_t i = 0; i < n_rfe; ++i)
    joints[2 + i] = {.kind = Kind::kSpherical,
                     .axis = 2,
                     .parent = static_cast<int>(i) + 1,
                     .shifted = true,
                     .shifted_along_x = true,
                     .sprung = i > 0,
                     .inertia = Inertia::kAxisymmetric,
                     .com_at_origin = false};
  joints[2 + n_rfe] = {.kind = Kind::kTranslation, .axis = 0, .shifted = true, .inertia = Inertia::kDiagonal};
  joints[3 + n_rfe] = {.kind = Kind::kRotation,
                       .axis = yoke_axis,
                       .parent = static_cast<int>(n_rfe) + 2,
                       .shifted_along_x = true,
                       .inertia = Inertia::kDiagonal};
  return joints;
}

template <std::size_t n_rfe, int yoke_axis>
consteval auto make_rpsup_traits() {
  auto joints = list_rpsup_joints<n_rfe, yoke_axis>();
  complete_traits(joints);
  return joints;
}

/// The rigid linkage whose crank an actuator moves, with the most coordinates that an actuator has: charge of
/// a motor's winding, integral of a controller.
consteval std::array<JointTraits, 7> make_actuated_rpsup_traits() {
  using Kind = JointTraits::Kind;
  using Inertia = JointTraits::Inertia;
  std::array<JointTraits, 7> joints{};
  std::ranges::copy(list_rpsup_joints<1, 0>(), joints.begin());
  joints[0].driven = false;
  joints[0].drive = -1;
  joints[0].has_armature = true;
  joints[1].drive = 0;
  for (std::size_t i : {5, 6})
    joints[i] = {.kind = Kind::kRotation,
                 .axis = 2,
                 .shifted_along_x = true,
                 .sprung = true,
                 .inertia = Inertia::kAxisymmetric};
  complete_traits(joints);
  return joints;
}

inline constexpr auto kRigidRpsup = make_rpsup_traits<1, 0>();
inline constexpr auto kFlexibleRpsup = make_rpsup_traits<4, 0>();
inline constexpr auto kRigidRpsupAcross = make_rpsup_traits<1, 1>();
inline constexpr auto kFlexibleRpsupAcross = make_rpsup_traits<4, 1>();
inline constexpr auto kActuatedRpsup = make_actuated_rpsup_traits();

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
