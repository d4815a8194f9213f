// SPDX-License-Identifier: Apache-2.0
#include "engine/model/applied_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "engine/clearance/friction_law.h"

namespace engine {

namespace {

/// A quantity with its derivatives by what a force element reads.
struct Derived {
  double value = 0.0;
  double by_t = 0.0, by_q = 0.0, by_v = 0.0, by_integral = 0.0;
};

struct ControllerOutput {
  Derived output;         ///< limited
  Derived integral_rate;  ///< xd
};

Derived calc_error(const Controller& controller, const DrivenMotion& target, const ElementState& state) {
  if (controller.controlled == Controller::Controlled::kPosition)
    return {.value = target.q - state.q, .by_t = target.qd, .by_q = -1.0};
  return {.value = target.qd - state.v, .by_t = target.qdd, .by_v = -1.0};
}

Derived add_scaled(const Derived& a, double factor, const Derived& b) {
  return {a.value + factor * b.value, a.by_t + factor * b.by_t, a.by_q + factor * b.by_q,
          a.by_v + factor * b.by_v, a.by_integral + factor * b.by_integral};
}

ControllerOutput calc_controller(const Controller& controller, double t, const ElementState& state) {
  const DrivenMotion target = calc_driven_motion(controller.target, t);
  const Derived error = calc_error(controller, target, state);
  const Derived integral{.value = state.memory, .by_integral = 1.0};
  const Derived error_rate{.value = target.qd - state.v, .by_t = target.qdd, .by_v = -1.0};
  Derived wanted = add_scaled({}, controller.proportional, error);
  wanted = add_scaled(wanted, controller.integral, integral);
  if (controller.derivative != 0.0) wanted = add_scaled(wanted, controller.derivative, error_rate);
  if (std::abs(wanted.value) <= controller.limit) return {wanted, error};
  const Derived limited{.value = std::copysign(controller.limit, wanted.value)};
  if (controller.integral == 0.0) return {limited, error};
  const double back_calculation = 1.0 / (controller.integral * controller.tracking_time);
  return {limited, add_scaled(error, back_calculation, add_scaled(limited, -1.0, wanted))};
}

/// With the driven coordinate and the integral as inputs.
AppliedForceValue to_value(const Derived& d) {
  return {.force = d.value, .by_t = d.by_t, .by_q = {d.by_q, 0.0}, .by_v = {d.by_v, d.by_integral}};
}

/// Argument of a force law, and the derivative of the force by that.
struct LawArgument {
  double value;
  double* slope;
};

LawArgument argument_of(const ForceLaw& law, double t, const ElementState& state, AppliedForceValue& force) {
  switch (law.variable) {
    case ForceLaw::Variable::kTime: return {t, &force.by_t};
    case ForceLaw::Variable::kPosition: return {state.q, &force.by_q[0]};
    case ForceLaw::Variable::kVelocity: break;
  }
  return {state.v, &force.by_v[0]};
}

void calc_forces(const ForceLaw& law, double t, const ElementState& state, AppliedForceValue* values) {
  values[0] = {};
  const LawArgument argument = argument_of(law, t, state, values[0]);
  const SignalPoint point = calc_signal(law.law, argument.value);
  values[0].force = point.value;
  *argument.slope = point.slope;
}

void calc_forces(const Controller& controller, double t, const ElementState& state,
                 AppliedForceValue* values) {
  const ControllerOutput at = calc_controller(controller, t, state);
  values[0] = to_value(at.output);
  if (controller.integral != 0.0) values[1] = to_value(at.integral_rate);
}

/// Friction of rotor and gear: n T eta^s - n k i.
AppliedForceValue calc_motor_loss(const DcMotor& motor, const ElementState& state) {
  const double n = motor.gear_ratio, k = motor.torque_constant;
  const double w = n * state.v;
  if (motor.dry_friction == 0.0 && motor.gear_efficiency == 1.0)
    return {.force = -n * motor.viscous_friction * w, .by_v = {-n * n * motor.viscous_friction, 0.0}};
  const double reversal = std::tanh(w / motor.reversal_velocity);
  const double reversal_by_w = (1.0 - reversal * reversal) / motor.reversal_velocity;
  const double torque = k * state.current - motor.viscous_friction * w - motor.dry_friction * reversal;
  const double torque_by_w = -motor.viscous_friction - motor.dry_friction * reversal_by_w;
  const double direction = std::copysign(1.0, torque);
  const double log_efficiency = std::log(motor.gear_efficiency);
  const double passed = std::exp(log_efficiency * direction * reversal);
  const double passed_by_w = passed * log_efficiency * direction * reversal_by_w;
  AppliedForceValue loss;
  loss.force = n * (torque * passed - k * state.current);
  loss.by_v = {n * n * (torque_by_w * passed + torque * passed_by_w), n * k * (passed - 1.0)};
  return loss;
}

void calc_forces(const DcMotor& motor, double t, const ElementState& state, AppliedForceValue* values) {
  const double nk = motor.gear_ratio * motor.torque_constant;
  values[kElectromagnetic] = {.force = nk * state.current, .by_v = {nk, 0.0}};
  values[kMotorLoss] = calc_motor_loss(motor, state);
  values[kBackEmf] = {.force = -nk * state.v, .by_v = {-nk, 0.0}};
  if (const auto* const controller = std::get_if<Controller>(&motor.voltage)) {
    calc_forces(*controller, t, state, values + kSupply);
    return;
  }
  const SignalPoint supply = calc_signal(std::get<Signal>(motor.voltage), t);
  values[kSupply] = {.force = supply.value, .by_t = supply.slope};
}

/// Against the sliding, with the driven coordinate and the bristle as inputs.
void calc_forces(const JointFriction& friction, double /*t*/, const ElementState& state,
                 AppliedForceValue* values) {
  const auto seeded = [](double value, int lane) {
    Lanes lanes{};
    lanes.set(lane, 1.0);
    return Dual(value, lanes);
  };
  const double sigma_0 = friction.law.sigma_0;
  const Dual v = friction.radius * seeded(state.v, 0), z = seeded(state.memory, 1) / sigma_0;
  const FrictionForce<Dual> law = calc_friction(friction.law, v, Dual(0.0), z, Dual(0.0));
  const auto value_of = [](const Dual& d) {
    return AppliedForceValue{.force = d.value, .by_v = {d.d[0], d.d[1]}};
  };
  const double normal_force = friction.normal_force + (friction.by_reaction ? state.reaction : 0.0);
  values[0] = value_of((-friction.radius * normal_force) * law.along_t.force_ratio);
  if (has_bristles(friction.law.law)) values[1] = value_of(sigma_0 * law.along_t.rate);
}

void list_forces(const ForceLaw&, const Actuation& of, std::vector<AppliedForce>& forces) {
  forces.push_back({.coordinate = of.coordinate, .inputs = {of.coordinate, kGround}});
}

/// @param acts_on  the driven coordinate, or the charge of the winding that the controller feeds
void list_forces(const Controller& controller, FrameIndex acts_on, const Actuation& of,
                 std::vector<AppliedForce>& forces) {
  const std::array<FrameIndex, kForceInputs> inputs{of.coordinate, of.memory};
  forces.push_back({.coordinate = acts_on, .inputs = inputs});
  if (controller.integral != 0.0)
    forces.push_back({.coordinate = of.memory, .inputs = inputs, .power = PowerKind::kNone});
}

void list_forces(const Controller& controller, const Actuation& of, std::vector<AppliedForce>& forces) {
  list_forces(controller, of.coordinate, of, forces);
}

void list_forces(const DcMotor& motor, const Actuation& of, std::vector<AppliedForce>& forces) {
  forces.push_back(
      {.coordinate = of.coordinate, .inputs = {of.winding, kGround}, .power = PowerKind::kNone});
  forces.push_back(
      {.coordinate = of.coordinate, .inputs = {of.coordinate, of.winding}, .power = PowerKind::kLoss});
  forces.push_back(
      {.coordinate = of.winding, .inputs = {of.coordinate, kGround}, .power = PowerKind::kNone});
  if (const auto* const controller = std::get_if<Controller>(&motor.voltage))
    list_forces(*controller, of.winding, of, forces);
  else
    forces.push_back({.coordinate = of.winding, .inputs = {kGround, kGround}});
}

void list_forces(const JointFriction& friction, const Actuation& of, std::vector<AppliedForce>& forces) {
  const std::array<FrameIndex, kForceInputs> inputs{of.coordinate, of.memory};
  forces.push_back({.coordinate = of.coordinate, .inputs = inputs, .power = PowerKind::kFriction});
  if (has_bristles(friction.law.law))
    forces.push_back({.coordinate = of.memory, .inputs = inputs, .power = PowerKind::kNone});
}

/// The controller of a force element, if it has one.
const Controller* controller_of(const ForceElement& element) {
  if (const auto* const motor = std::get_if<DcMotor>(&element))
    return std::get_if<Controller>(&motor->voltage);
  return std::get_if<Controller>(&element);
}

/// The signal of time of a force element, if it has one.
const Signal* signal_of_time(const ForceElement& element) {
  if (const auto* const motor = std::get_if<DcMotor>(&element)) return std::get_if<Signal>(&motor->voltage);
  const auto* const law = std::get_if<ForceLaw>(&element);
  return law && law->variable == ForceLaw::Variable::kTime ? &law->law : nullptr;
}

/// A rotation about a point of the ground of a body without weight: only its inertia tells.
FrameIndex add_auxiliary(Mechanism& mechanism, std::string name, CoordinateRole role, double inertia) {
  Coordinate& coordinate = mechanism.coordinates.emplace_back();
  coordinate.name = std::move(name);
  coordinate.role = role;
  coordinate.start = coordinate.start_rate = 0.0;
  coordinate.mass = 1.0;
  coordinate.inertia = inertia * Eigen::Matrix3d::Identity();
  return static_cast<FrameIndex>(mechanism.coordinates.size()) - 1;
}

/// Adds the coordinate in which an element has its integral or its bristle.
/// @returns kGround if it needs none
FrameIndex add_memory(Mechanism& mechanism, const std::string& name, const ForceElement& element) {
  const Controller* const controller = controller_of(element);
  if (controller && controller->integral != 0.0)
    return add_auxiliary(mechanism, name + "_integral", CoordinateRole::kMemory, 1.0);
  const auto* const friction = std::get_if<JointFriction>(&element);
  if (friction && has_bristles(friction->law.law))
    return add_auxiliary(mechanism, name + "_bristle", CoordinateRole::kMemory, 1.0);
  return kGround;
}

}  // namespace

std::vector<AppliedForce> list_applied_forces(const Actuation& actuation) {
  std::vector<AppliedForce> forces;
  std::visit([&](const auto& element) { list_forces(element, actuation, forces); }, actuation.element);
  return forces;
}

std::vector<AppliedForce> list_applied_forces(const Mechanism& mechanism) {
  std::vector<AppliedForce> forces;
  for (const Actuation& actuation : mechanism.actuations) {
    const std::vector<AppliedForce> of_one = list_applied_forces(actuation);
    forces.insert(forces.end(), of_one.begin(), of_one.end());
  }
  int works = 0;
  for (AppliedForce& force : forces)
    if (force.power != PowerKind::kNone) force.work = works++;
  return forces;
}

void calc_applied_forces(const Actuation& actuation, double t, const ElementState& state,
                         AppliedForceValue* values) {
  std::visit([&](const auto& element) { calc_forces(element, t, state, values); }, actuation.element);
}

double find_next_step_end(const Actuation& actuation, double t) {
  if (const Controller* const controller = controller_of(actuation.element))
    return find_next_step_end(controller->target, t);
  const Signal* const signal = signal_of_time(actuation.element);
  return signal ? find_next_point(*signal, t) : std::numeric_limits<double>::infinity();
}

bool is_passed_by(const Actuation& actuation, const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                  const Eigen::VectorXd& qd_from, const Eigen::VectorXd& qd_to) {
  constexpr double kLeast = 0.02;  // of the table's range
  const auto* const law = std::get_if<ForceLaw>(&actuation.element);
  const auto* const table = law ? std::get_if<TableCurve>(&law->law) : nullptr;
  if (!table || law->variable == ForceLaw::Variable::kTime) return false;
  const bool by_position = law->variable == ForceLaw::Variable::kPosition;
  const FrameIndex i = actuation.coordinate;
  return table->calc_bulge((by_position ? q_from : qd_from)[i], (by_position ? q_to : qd_to)[i]) > kLeast;
}

void bend_bristles(const Mechanism& mechanism, Eigen::VectorXd& qd) {
  for (const Actuation& actuation : mechanism.actuations) {
    const auto* const friction = std::get_if<JointFriction>(&actuation.element);
    if (!friction || !has_bristles(friction->law.law)) continue;
    const double v = friction->radius * qd[actuation.coordinate];
    const FrictionParameters& law = friction->law;
    qd[actuation.memory] = calc_stribeck_curve(law, std::abs(v)) * std::tanh(v / law.v_s);
  }
}

void add_actuation(Mechanism& mechanism, FrameIndex coordinate, const ForceElement& element) {
  Actuation actuation{.coordinate = coordinate, .element = element};
  const std::string name = mechanism.coordinates[static_cast<std::size_t>(coordinate)].name;
  if (const auto* const motor = std::get_if<DcMotor>(&element)) {
    mechanism.coordinates[static_cast<std::size_t>(coordinate)].armature +=
        motor->gear_ratio * motor->gear_ratio * motor->rotor_inertia;
    actuation.winding =
        add_auxiliary(mechanism, name + "_charge", CoordinateRole::kCharge, motor->inductance);
    mechanism.coordinates.back().damping = motor->resistance;
  }
  actuation.memory = add_memory(mechanism, name, element);
  mechanism.actuations.push_back(std::move(actuation));
}

}  // namespace engine
