// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "engine/model/mechanism.h"

namespace engine {

/// Number of coordinates on which an applied force may depend.
inline constexpr int kForceInputs = 2;

/// The part that the power of an applied force has in the energy account.
enum class PowerKind {
  kSource,    ///< work of a drive
  kLoss,      ///< of an actuator: counted with the dampers
  kFriction,  ///< dry friction in a joint
  kNone,      ///< the rate of a memory; also a motor's torque and back-EMF, whose powers add up to 0
};

/// A generalised force on a coordinate.
struct AppliedForce {
  FrameIndex coordinate = 0;
  std::array<FrameIndex, kForceInputs> inputs{kGround, kGround};  ///< coordinates; kGround: none
  PowerKind power = PowerKind::kSource;
  int work = -1;  ///< index among the works of all applied forces; -1: kNone has none
};

/// An applied force at one instant, with its partial derivatives.
struct AppliedForceValue {
  double force = 0.0;  ///< [N] or [N m]; [V] on the charge of a winding
  double by_t = 0.0;
  std::array<double, kForceInputs> by_q{}, by_v{};  ///< by position and velocity of the inputs
};

/// Values at one instant of all applied forces and of the laws of all body loads, for the kernel.
struct AppliedValues {
  const AppliedForceValue* forces = nullptr;
  const SignalPoint* body_loads = nullptr;
};

/// The state that a force element depends on.
struct ElementState {
  double q = 0.0, v = 0.0;  ///< of the driven coordinate
  double current = 0.0;     ///< [A]
  double memory = 0.0;      ///< x of the controller, or sigma_0 z of the bristle
  double reaction = 0.0;    ///< normal force by the joint's reaction, [N]
};

/// Parts of a motor's applied forces, in their order.
enum MotorForce { kElectromagnetic, kMotorLoss, kBackEmf, kSupply };

/// The applied forces of a force element; those of a motor in the order of MotorForce.
[[nodiscard]] std::vector<AppliedForce> list_applied_forces(const Actuation& actuation);
/// Those of all force elements in their order, their works counted.
[[nodiscard]] std::vector<AppliedForce> list_applied_forces(const Mechanism& mechanism);

/// Their values. Allocates nothing.
/// @param values  out: one for each of list_applied_forces()
void calc_applied_forces(const Actuation& actuation, double t, const ElementState& state,
                         AppliedForceValue* values);

/// First instant after t at which a step has to end: a point of the force element's law over time, or as
/// find_next_step_end() of a controller's target. Infinite if none follows, [s]
[[nodiscard]] double find_next_step_end(const Actuation& actuation, double t);

/// @returns whether a force over position or velocity is another one on the way between two instants than a
/// straight line between them has: a step from the one to the other would pass it by
[[nodiscard]] bool is_passed_by(const Actuation& actuation, const Eigen::VectorXd& q_from,
                                const Eigen::VectorXd& q_to, const Eigen::VectorXd& qd_from,
                                const Eigen::VectorXd& qd_to);

/// Bends the bristles of joints that move at the start as far as steady sliding does:
///
///     sigma_0 z = g(v) tanh(v / v_s)
///
/// @param qd  rates of all coordinates; those of the bristles are sigma_0 z
void bend_bristles(const Mechanism& mechanism, Eigen::VectorXd& qd);

/// Adds the coordinates that a force element needs beside the given one: the charge of a winding, the
/// integral of a controller, a bristle; and the inertia of a rotor.
void add_actuation(Mechanism& mechanism, FrameIndex coordinate, const ForceElement& element);

}  // namespace engine
