// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/model/rpsup_parameters.h"
#include "validation/engine_names.h"

namespace validation {

/// A second geometry of the linkage, whose peaks with clearance six other codes agree on: the cross link
/// turns across the guide, the crank's axis is level, the rod's stroke is long and smooth, the journal's
/// faces are stiff.
[[nodiscard]] inline RpsupParameters across_rpsup() {
  RpsupParameters p;
  p.yoke_axis = YokeAxis::kAcross;
  p.gravity_direction = Direction::kMinusY;
  p.guide_offset_z = 0.2;
  p.rod_start = p.rod_length;
  p.rod_stroke = 0.05;
  p.rod_law = StrokeLaw::kCycloidal;
  p.coupler_damping_ratio = 0.01;
  p.bearing_length = 20e-3;
  p.radial_levels = 2;
  p.axial_stiffness = 1e8;
  return p;
}

}  // namespace validation
