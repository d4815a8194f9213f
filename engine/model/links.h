// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "engine/flexible/rfem.h"

namespace engine {

/// Mass properties of one link. Moments are about the link's frame origin, along its frame's axes.
struct LinkInertia {
  double mass = 0.0;                                   ///< [kg], > 0
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();   ///< (I_x, I_y, I_z), [kg m^2], > 0
};

/// The links of the linkage, in the order of an array of them.
enum class Link : std::size_t { k11, k12, k13, k21, k22 };
inline constexpr std::size_t kLinkCount = 5;

/// A link that is a uniform beam along x, its frame's origin at one end. @param I_x  about its axis, [kg m^2]
[[nodiscard]] inline LinkInertia beam_inertia(double mass, double length, double I_x) {
  return {mass, calc_beam_inertia({.length = length, .mass = mass, .I_x = I_x})};
}

}  // namespace engine
