// SPDX-License-Identifier: Apache-2.0
#include "validation/flexibility/links.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace validation {

RpsupParameters with_cross(double length) {
  RpsupParameters p;
  const LinkInertia tube = beam_inertia(1.07 * length, length, 8.377e-5 * length);
  p.cross_length = length;
  p.links[static_cast<std::size_t>(Link::k22)] = {tube.mass,
                                                  {tube.inertia.y(), tube.inertia.z(), tube.inertia.x()}};
  return p;
}

RpsupParameters with_flexible(const FlexibleLink& link, int segments) {
  RpsupParameters p = with_cross(0.1);
  RoundLink& form = p.*link.form;
  form.model = LinkModel::kFlexible;
  form.elements = segments + 1;
  return p;
}

double calc_EI(const RoundLink& form) {
  return 2.1e11 * std::numbers::pi * (std::pow(form.diameter, 4) - std::pow(form.inner_diameter, 4)) / 64.0;
}

Mechanism clamp_link(const Rpsup& rpsup) {
  const BentLink& link = rpsup.layout.bent.at(0);
  const FrameIndex first = link.root.frame + 1;
  Mechanism clamped;
  for (FrameIndex i = first; i <= link.tip.frame; ++i) {
    Coordinate c = rpsup.mechanism.coordinates[static_cast<std::size_t>(i)];
    c.parent = i == first ? kGround : c.parent - first;
    clamped.coordinates.push_back(c);
  }
  return clamped;
}

}  // namespace validation
