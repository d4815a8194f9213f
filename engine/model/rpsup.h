// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/model/linkage.h"
#include "engine/model/mechanism.h"
#include "engine/model/rpsup_parameters.h"

namespace engine {

/// A flexible link as built: its two end elements.
struct BentLink {
  std::string name;             ///< as in channels
  BodyFrames::Part root;        ///< its first element
  BodyFrames::Part tip;         ///< its last element, which ends at `length` along the beam
  double length = 0.0;          ///< [m]
};

/// Places of the study's quantities in the mechanism of an RPSUP linkage.
struct RpsupLayout {
  FrameIndex crank = 0;     ///< psi^(1,1), the first drive
  FrameIndex rod = 0;       ///< z^(1,2), the second drive
  FrameIndex coupler = 0;   ///< frame of link (1,3), or of its first element
  FrameIndex slider = 0;    ///< z^(2,1)
  std::vector<BentLink> bent;  ///< crank, rod and cross link, of them those that are flexible
};

struct Rpsup {
  Mechanism mechanism;
  RpsupLayout layout;
};

/// Builds the linkage R P S U P: chain 1 is crank, rod and coupler, chain 2 slider and cross link, closed by
/// the revolute joint between coupler and cross link. Every link but the slider is rigid or divided. The
/// rod's guide is the crank's frame; that of a flexible crank is the end of the crank, which holds the rod's
/// origin by the crank's length behind it. Source: project paper, section 2 and Table 1.
[[nodiscard]] Rpsup build_rpsup(const RpsupParameters& parameters);

/// The joint of the linkage, with clearance; Hertz's stiffness is that of its material.
[[nodiscard]] ClearanceParameters make_clearance(const RpsupParameters& parameters);

/// The same linkage and drives with rigid links, prescribed drives and an ideal joint: what the mechanism is
/// meant to do.
[[nodiscard]] Rpsup build_ideal_rpsup(RpsupParameters parameters);

}  // namespace engine
