// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/actuator_readings.h"

#include <utility>
#include <variant>

#include "engine/model/applied_force.h"

namespace engine {

namespace {

/// Readings of a motor, but for its power. @param first  index of the motor's first applied force
ActuatorReadings make_motor_readings(FrameIndex winding, Eigen::Index first) {
  ActuatorReadings readings;
  readings.force = [first](const Evaluation& at) {
    return at.applied_force[first + kElectromagnetic] + at.applied_force[first + kMotorLoss];
  };
  readings.current = [winding](const Evaluation& at) { return at.qd[winding]; };
  readings.voltage = [first](const Evaluation& at) { return at.applied_force[first + kSupply]; };
  readings.electric_work = [first](const Evaluation& at) { return at.applied_work[first + kSupply]; };
  return readings;
}

/// @param first  index of the actuator's first applied force
ActuatorReadings make_readings(const Actuation& actuation, Eigen::Index first) {
  const FrameIndex coordinate = actuation.coordinate;
  ActuatorReadings readings;
  if (std::holds_alternative<DcMotor>(actuation.element))
    readings = make_motor_readings(actuation.winding, first);
  else
    readings.force = [first](const Evaluation& at) { return at.applied_force[first]; };
  readings.power = [coordinate, force = readings.force](const Evaluation& at) {
    return force(at) * at.qd[coordinate];
  };
  return readings;
}

}  // namespace

std::vector<ActuatorReadings> find_actuator_readings(const Mechanism& mechanism, FrameIndex coordinate) {
  std::vector<ActuatorReadings> found;
  Eigen::Index first = 0;
  for (const Actuation& actuation : mechanism.actuations) {
    if (actuation.coordinate == coordinate) found.push_back(make_readings(actuation, first));
    first += static_cast<Eigen::Index>(list_applied_forces(actuation).size());
  }
  return found;
}

}  // namespace engine
