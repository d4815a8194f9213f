// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <stdexcept>
#include <utility>

#include "engine/dynamics/motion_system.h"
#include "engine/integrate/integration.h"
#include "engine/model/mechanism.h"
#include "validation/engine_names.h"

namespace validation {

/// A mass that flies along x inside the bore of a bearing on the ground, with one ring of contact and no faces within reach.
[[nodiscard]] inline Mechanism make_free_mass(double mass, ClearanceParameters joint) {
  joint.n_r = 1;
  joint.c_a = 1.0;
  Mechanism m;
  m.coordinates.push_back({.name = "x", .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kX, .mass = mass});
  m.cut_joints.push_back({.bearing_frame = kGround, .journal_frame = 0, .bearing = {}, .journal = {}, .clearance = joint});
  return m;
}

/// 1 kg that lies in the bore under a gravity of 1 m/s^2, so that the normal force is 1 N, and slides along the bearing's axis z: the
/// coordinates are that of a carriage driven at constant velocity, the mass's displacement on it, held by a spring, and its height.
[[nodiscard]] inline Mechanism make_slider(const FrictionParameters& friction, double velocity, double spring) {
  ClearanceParameters joint;
  joint.c_r = 1e-3;
  joint.c_a = 10.0;
  joint.n_r = 1;
  joint.K = 1e5;
  joint.chi = 0.0;
  joint.friction = friction;
  Mechanism m;
  m.coordinates.push_back({.name = "carriage", .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kZ});
  m.coordinates.push_back({.name = "displacement", .parent = 0, .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kZ,
                           .stiffness = spring});
  m.coordinates.push_back({.name = "height", .parent = 1, .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kY, .mass = 1.0});
  m.gravity_W = {0.0, -1.0, 0.0};
  m.drives = {{0, RunUp{velocity, 0.0}}};
  m.cut_joints.push_back({.bearing_frame = kGround, .journal_frame = 2, .bearing = {}, .journal = {}, .clearance = joint});
  return m;
}

/// Height at which the slider's mass lies still on the bore: K delta^1.5 = 1 N.
[[nodiscard]] inline double resting_height(const Mechanism& slider) {
  const ClearanceParameters& joint = *slider.cut_joints[0].clearance;
  return -joint.c_r - std::pow(1.0 / joint.K, 2.0 / 3.0);
}

/// Integrates a mechanism from given coordinates, without closing loops. The run must succeed or be stopped by the observer.
inline RunOutcome run_from(const Mechanism& mechanism, const RunOptions& options, Eigen::VectorXd q, Eigen::VectorXd qd, Observer& observer) {
  Evaluation start = MotionSystem(mechanism).make_evaluation();
  start.q = std::move(q);
  start.qd = std::move(qd);
  RunOutcome end = Integration(mechanism, options, observer).run(start);
  if (end.status != RunStatus::kSucceeded && end.status != RunStatus::kStopped)
    throw std::runtime_error("a run of the validation failed: " + end.detail);
  return end;
}

}  // namespace validation
