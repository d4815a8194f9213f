// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "engine/model/rpsup.h"
#include "engine/model/rpsup_parameters.h"
#include "validation/engine_names.h"

namespace validation {

/// One of the links that may be flexible beside the coupler.
struct FlexibleLink {
  const char* name;
  Link link;
  RoundLink RpsupParameters::*form;
  double RpsupParameters::*length;
};
inline constexpr std::array<FlexibleLink, 3> kFlexibleLinks{
    {{"crank", Link::k11, &RpsupParameters::crank, &RpsupParameters::crank_length},
     {"rod", Link::k12, &RpsupParameters::rod, &RpsupParameters::rod_length},
     {"cross", Link::k22, &RpsupParameters::cross, &RpsupParameters::cross_length}}};

/// With a cross link of this length: the study's tube, 20/15 mm, cut to it.
[[nodiscard]] RpsupParameters with_cross(double length);

/// With a cross link of 0.1 m, and one link flexible.
[[nodiscard]] RpsupParameters with_flexible(const FlexibleLink& link, int segments);

/// Of a steel tube or rod, [N m^2].
[[nodiscard]] double calc_EI(const RoundLink& form);

/// The first link that is flexible, cut out of the linkage, its first element fixed to the ground.
[[nodiscard]] Mechanism clamp_link(const Rpsup& rpsup);

}  // namespace validation
