// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/model/linkage.h"

namespace bench {

/// A described linkage, at rest with all coordinates zero, in a slanting field of gravity.
struct LargeLinkage {
  engine::Linkage linkage;
  std::string measured;  ///< freedom whose acceleration is compared, a rotation
};

/// A binary tree of rods that hang from each other by revolute joints with some damping. Axes are x and y by
/// turns.
[[nodiscard]] LargeLinkage make_tree(int bodies);

/// Bars that hang from the ground by revolute joints; a coupler leads from each to the next, with a universal
/// joint at one end and a spherical one, which closes a loop, at the other. One degree of freedom is left.
[[nodiscard]] LargeLinkage make_chain(int loops);

}  // namespace bench
