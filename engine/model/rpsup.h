#pragma once

#include "engine/model/mechanism.h"
#include "engine/model/rpsup_parameters.h"

namespace engine {

/// Where the study's quantities are found in the mechanism of an RPSUP linkage.
struct RpsupLayout {
  FrameIndex crank = 0;     ///< psi^(1,1), the first drive
  FrameIndex rod = 0;       ///< z^(1,2), the second drive
  FrameIndex coupler = 0;   ///< frame of link (1,3), or of its first element
  FrameIndex slider = 0;    ///< z^(2,1)
};

struct Rpsup {
  Mechanism mechanism;
  RpsupLayout layout;
};

/// Builds the linkage R P S U P: chain 1 is crank, rod and coupler (rigid or divided), chain 2 slider and cross link,
/// closed by the revolute joint between coupler and cross link. Source: project paper, section 2 and Table 1.
[[nodiscard]] Rpsup build_rpsup(const RpsupParameters& parameters);

/// The joint of the linkage, with clearance; Hertz's stiffness is that of its material.
[[nodiscard]] ClearanceParameters make_clearance(const RpsupParameters& parameters);

/// The same linkage and drives with a rigid coupler, prescribed drives and an ideal joint: what the mechanism is meant to do.
[[nodiscard]] Rpsup build_ideal_rpsup(RpsupParameters parameters);

/// By how much the coupler reaches the slider's guide at time t, squared: l^2 less the squared distance of the S joint from the guide.
/// Negative or zero: the linkage cannot be assembled there, or locks. [m^2]
[[nodiscard]] double calc_reach_squared(const RpsupParameters& parameters, double t);

}  // namespace engine
