// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <variant>

#include "engine/clearance/friction_parameters.h"
#include "engine/model/drive_law.h"
#include "engine/model/signal.h"

namespace engine {

/// A force or torque by a law: a torque over time, the torque-speed curve of an induction motor, the pressure
/// over a stroke, an end stop, a nonlinear spring.
struct ForceLaw {
  enum class Variable {
    kTime,      ///< [s]
    kPosition,  ///< q of the coordinate, [rad] or [m]
    kVelocity,  ///< qd of the coordinate, [rad/s] or [m/s]
  };
  Signal law;  ///< [N m] or [N]
  Variable variable = Variable::kTime;
};

/// Proportional-integral-derivative control with limits. Anti-windup by back-calculation: K. J. Astrom, T.
/// Hagglund, PID Controllers (1995), Section 3.5.
///
///     u = K_p e + K_i x + K_d ed,  limited to +-limit
///     xd = e + (limited u - u) / (K_i T_t),  x(0) = 0
///
/// with the error e = q_target - q, or qd_target - qd of a controller of the velocity, which has no K_d.
struct Controller {
  enum class Controlled { kPosition, kVelocity };
  DriveLaw target;
  Controlled controlled = Controlled::kVelocity;
  double proportional = 0.0;                               ///< K_p, output unit by that of the error
  double integral = 0.0;                                   ///< K_i, the same by s
  double derivative = 0.0;                                 ///< K_d, the same times s
  double limit = std::numeric_limits<double>::infinity();  ///< > 0, [N m], [N] or [V]
  double tracking_time = 0.0;  ///< T_t, > 0 where K_i and the limit are given, [s]
};

/// A permanent-magnet direct-current motor with a gear. The rotor turns by n q, q the driven coordinate:
///
///     L id + R i = V - k n qd
///     T = k i - b n qd - T_d tanh(n qd / w_s)
///     force on the coordinate = n T eta^s - n^2 J qdd,  s = sign(T) tanh(n qd / w_s)
///
/// so that the gear passes eta of the power on, to the linkage or, where that drives the rotor, to the rotor.
/// Source: A. Hughes, B. Drury, Electric Motors and Drives (2019), Chapter 3.
struct DcMotor {
  std::variant<Signal, Controller> voltage;  ///< V, [V]; a signal of time
  double torque_constant = 0.0;              ///< k, also of the back-EMF, > 0, [N m/A] = [V s/rad]
  double resistance = 0.0;                   ///< R, > 0, [ohm]
  double inductance = 0.0;                   ///< L, > 0, [H]
  double gear_ratio = 1.0;                   ///< n, not 0, [1] or of a coordinate that slides [rad/m]
  double gear_efficiency = 1.0;              ///< eta, (0, 1]
  double rotor_inertia = 0.0;                ///< J, [kg m^2]
  double viscous_friction = 0.0;             ///< b, [N m s/rad]
  double dry_friction = 0.0;                 ///< T_d, [N m]
  double reversal_velocity = 0.1;            ///< w_s of the rotor, > 0, [rad/s]
};

/// The mover of a coordinate whose motion is not given.
using Actuator = std::variant<ForceLaw, Controller, DcMotor>;

/// Dry friction in a joint without play under a normal force N, by a law of friction_law.h:
///
///     force on the coordinate = -r N (sigma_0 z + sigma_1 zd + sigma_2 v),  v = r qd
///
/// or by the law's force ratio where it has no bristle z. N is the given preload, and with `by_reaction` what
/// the joint bears beside it: see ReactionFriction.
struct JointFriction {
  FrictionParameters law;
  double normal_force = 0.0;  ///< preload, >= 0, [N]
  double radius = 1.0;  ///< r at which surfaces slide where the joint turns, > 0, [m]; 1 where it slides
  bool by_reaction = false;
  double length = 0.0;  ///< of the bearing or guide about the origin of what it carries, [m]; 0: no moment
};

/// The cause of a force on a coordinate.
using ForceElement = std::variant<ForceLaw, Controller, DcMotor, JointFriction>;

}  // namespace engine
