// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/analysis/readings.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Readings of an actuator. The last three are empty but for a motor.
struct ActuatorReadings {
  Reading force = {};          ///< on the coordinate, without the rotor's inertia, [N] or [N m]
  Reading power = {};          ///< of that force, [W]
  Reading current = {};        ///< [A]
  Reading voltage = {};        ///< of the supply, [V]
  Reading electric_work = {};  ///< of the supply since t = 0, [J]
};

/// Readings of the actuators of a coordinate, in the order of Mechanism::actuations.
[[nodiscard]] std::vector<ActuatorReadings> find_actuator_readings(const Mechanism& mechanism,
                                                                   FrameIndex coordinate);

}  // namespace engine
