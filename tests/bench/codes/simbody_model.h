// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Simbody.h>

#include "tests/bench/codes/plain_linkage.h"

namespace bench {

/// The linkage in Simbody: bodies, joints, loops, gravity, springs and dampers, drives; without what acts
/// between bearing and journal.
///
/// Two rotations are a Universal, whose frames are turned so that it turns about x and y of its own. Three
/// rotations about z, y, x are a Gimbal; its frames are turned so that it turns about x, y, z of its own, the
/// last one backwards.
class SimbodyModel {
 public:
  explicit SimbodyModel(const PlainLinkage& plain);

  void place(SimTK::State& state) const;
  [[nodiscard]] const SimTK::MobilizedBody& body(int i) const { return bodies_[static_cast<std::size_t>(i)]; }

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  SimTK::GeneralForceSubsystem forces;

 private:
  void add_forces(const PlainCoordinate& c, SimTK::MobilizedBody& body, int which);

  const PlainLinkage& plain_;
  std::vector<SimTK::MobilizedBody> bodies_;
};

}  // namespace bench
