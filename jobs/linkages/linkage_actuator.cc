// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_actuator.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <string_view>
#include <utility>
#include <variant>

#include "engine/model/rpsup.h"
#include "jobs/linkages/actuator_fields.h"
#include "jobs/linkages/linkage_drive.h"
#include "jobs/linkages/linkage_joint.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/rpsup_drives.h"
#include "jobs/parameters/units.h"

namespace jobs {
namespace {

using nlohmann::json;
using Numbers = std::vector<double>;

std::string word_at(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

/// The keys of a table's variable, of which a table has one.
std::array<std::string, 3> variable_keys(engine::Motion motion) {
  const TableVariables of = table_variables(motion);
  return {std::string(of.times), std::string(of.positions), std::string(of.velocities)};
}

/// The key of a table's variable; empty if it has none or more than one.
std::string find_variable(const json& table, engine::Motion motion) {
  std::string found;
  for (const std::string& key : variable_keys(motion)) {
    if (!table.contains(key)) continue;
    if (!found.empty()) return "";
    found = key;
  }
  return found;
}

void check_effort_table(const json& table, const EffortKeys& effort, engine::Motion motion,
                        EffortVariables variables, const std::string& pointer, std::vector<Fault>& faults) {
  const std::string variable = find_variable(table, motion);
  if (variable.empty()) {
    const auto [times, positions, velocities] = variable_keys(motion);
    if (variables == EffortVariables::kTime) {
      faults.push_back({pointer + pointer_token(times), "is missing"});
      return;
    }
    faults.push_back({pointer, "must have one of " + times + ", " + positions + " and " + velocities});
    return;
  }
  check_table(table, variable, effort.values, pointer, faults);
}

/// An effort by a number or by a law. A number that is no number in its range has had its fault.
void check_effort(const json& effort, const EffortKeys& of, engine::Motion motion, EffortVariables variables,
                  const std::string& pointer, std::vector<Fault>& faults) {
  if (!effort.is_object()) return;
  const std::string law = word_at(effort, "law");
  const bool is_known = std::ranges::find(kEffortLaws, law) != std::end(kEffortLaws);
  const std::size_t before = faults.size();
  check_fields(is_known ? effort : json{{"law", effort.value("law", json())}},
               effort_fields(of, law, motion, variables), pointer, faults);
  if (faults.size() == before && law == "table")
    check_effort_table(effort, of, motion, variables, pointer, faults);
}

void check_controller(const json& controller, const EffortKeys& effort, engine::Motion motion,
                      const LinkageFields& beside, const std::string& pointer, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  LinkageFields fields = controller_fields(effort, word_at(controller, "controlled"), motion);
  fields.insert(fields.end(), beside.begin(), beside.end());
  check_fields(controller, fields, pointer, faults);
  if (controller.contains("target") && controller.at("target").is_object()) {
    if (is_actuator(controller.at("target")))
      faults.push_back({pointer + "/target", "must be a law, which gives a motion"});
    else check_drive(controller.at("target"), motion, pointer + "/target", faults);
  }
  const auto is_given = [&](const char* gain) { return controller.contains(gain); };
  if (faults.size() == before && !is_given("proportional") && !is_given("integral") &&
      !is_given("derivative"))
    faults.push_back({pointer, "must have a gain: proportional, integral or derivative"});
}

void check_motor(const json& motor, engine::Motion motion, const std::string& pointer,
                 std::vector<Fault>& faults) {
  LinkageFields fields = motor_fields(motion);
  fields.push_back(actuator_field(motion));
  check_fields(motor, fields, pointer, faults);
  if (motor.contains("voltage_v") == motor.contains("controller"))
    faults.push_back({pointer, "must have either a voltage_v or a controller"});
  if (motor.contains("voltage_v"))
    check_effort(motor.at("voltage_v"), voltage(), motion, EffortVariables::kTime, pointer + "/voltage_v",
                 faults);
  if (motor.contains("controller") && motor.at("controller").is_object())
    check_controller(motor.at("controller"), voltage(), motion, {}, pointer + "/controller", faults);
}

Eigen::Vector3d direction_of(const json& load) {
  const auto direction = load.at("direction").get<std::array<double, 3>>();
  return {direction[0], direction[1], direction[2]};
}

void fill_in_interpolation(json& effort) {
  if (effort.is_object() && effort.at("law") == "table" && !effort.contains("interpolation"))
    effort["interpolation"] = "monotone_cubic";
}

engine::TableCurve read_table(const json& table, const std::string& variable, std::string_view values) {
  const bool linear = table.value("interpolation", "") == "linear";
  return {table.at(variable).get<Numbers>(), table.at(values).get<Numbers>(),
          linear ? engine::TableInterpolation::kLinear : engine::TableInterpolation::kMonotoneCubic};
}

engine::ForceLaw read_effort(const json& given, const EffortKeys& effort, engine::Motion motion) {
  using Variable = engine::ForceLaw::Variable;
  if (given.is_number()) return {engine::Constant{given.get<double>()}};
  const std::string law = word_at(given, "law");
  if (law == "constant") return {engine::Constant{given.at(effort.key).get<double>()}};
  if (law == "harmonic")
    return {engine::Harmonic{given.value(effort.mean, 0.0), given.at(effort.amplitude).get<double>(),
                             2.0 * std::numbers::pi * given.at("frequency_hz").get<double>(),
                             given.value("phase_rad", 0.0)}};
  const std::string variable = find_variable(given, motion);
  const TableVariables of = table_variables(motion);
  return {read_table(given, variable, effort.values), variable == of.times       ? Variable::kTime
                                                      : variable == of.positions ? Variable::kPosition
                                                                                 : Variable::kVelocity};
}

engine::Controller read_controller(const json& given, const EffortKeys& effort, engine::Motion motion,
                                   const engine::RpsupParameters& defaults) {
  engine::Controller controller{.target = read_drive(given.at("target"), motion, defaults),
                                .controlled = given.at("controlled") == "position"
                                                  ? engine::Controller::Controlled::kPosition
                                                  : engine::Controller::Controlled::kVelocity,
                                .proportional = given.value("proportional", 0.0),
                                .integral = given.value("integral", 0.0),
                                .derivative = given.value("derivative", 0.0)};
  if (given.contains(effort.limit)) controller.limit = given.at(effort.limit).get<double>();
  const double gain_ratio = controller.proportional > 0.0 && controller.integral > 0.0
                                ? controller.proportional / controller.integral
                                : 1.0;
  controller.tracking_time = given.value("tracking_time_s", gain_ratio);
  return controller;
}

std::variant<engine::Signal, engine::Controller> read_voltage(const json& motor, engine::Motion motion,
                                                              const engine::RpsupParameters& defaults) {
  if (motor.contains("controller"))
    return read_controller(motor.at("controller"), voltage(), motion, defaults);
  return read_effort(motor.at("voltage_v"), voltage(), motion).law;
}

engine::DcMotor read_motor(const json& given, engine::Motion motion,
                           const engine::RpsupParameters& defaults) {
  engine::DcMotor motor;
  motor.voltage = read_voltage(given, motion, defaults);
  motor.torque_constant = given.at("torque_constant_n_m_a").get<double>();
  motor.resistance = given.at("resistance_ohm").get<double>();
  motor.inductance = given.at("inductance_h").get<double>();
  motor.gear_ratio = given.value(slides(motion) ? "gear_ratio_rad_m" : "gear_ratio", motor.gear_ratio);
  motor.gear_efficiency = given.value("gear_efficiency", motor.gear_efficiency);
  motor.rotor_inertia = given.value("rotor_inertia_kg_m2", motor.rotor_inertia);
  motor.viscous_friction = given.value("viscous_friction_n_m_s_rad", motor.viscous_friction);
  motor.dry_friction = given.value("dry_friction_n_m", motor.dry_friction);
  motor.reversal_velocity = given.value("reversal_velocity_rad_s", motor.reversal_velocity);
  return motor;
}

}  // namespace

void check_actuator(const json& actuator, engine::Motion motion, const std::string& pointer,
                    std::vector<Fault>& faults) {
  const EffortKeys& effort = force_or_torque(motion);
  const std::string kind = word_at(actuator, "actuator");
  if (kind == "controller")
    return check_controller(actuator, effort, motion, {actuator_field(motion)}, pointer, faults);
  if (kind == "dc_motor") return check_motor(actuator, motion, pointer, faults);
  if (kind != actuator_words(motion).front())
    return check_fields(json{{"actuator", actuator.at("actuator")}}, {actuator_field(motion)}, pointer,
                        faults);
  check_fields(actuator, {actuator_field(motion), effort_field(effort, "Number, or a law", true)}, pointer,
               faults);
  if (actuator.contains(effort.key))
    check_effort(actuator.at(effort.key), effort, motion, EffortVariables::kAny,
                 pointer + pointer_token(effort.key), faults);
}

json canonical_actuator(json actuator, engine::Motion motion) {
  const std::string key(force_or_torque(motion).key);
  for (const std::string& effort : {key, std::string(voltage().key)})
    if (actuator.contains(effort)) fill_in_interpolation(actuator[effort]);
  json& controller = actuator.contains("controller") ? actuator["controller"] : actuator;
  if (controller.contains("target")) controller["target"] = canonical_drive(controller["target"], motion);
  return actuator;
}

engine::Actuator read_actuator(const json& actuator, engine::Motion motion,
                               const engine::RpsupParameters& defaults) {
  const std::string kind = word_at(actuator, "actuator");
  const EffortKeys& effort = force_or_torque(motion);
  if (kind == "dc_motor") return read_motor(actuator, motion, defaults);
  if (kind == "controller") return read_controller(actuator, effort, motion, defaults);
  return read_effort(actuator.at(effort.key), effort, motion);
}

void check_load(const json& load, engine::Motion motion, const std::string& pointer,
                std::vector<Fault>& faults) {
  check_effort(load, force_or_torque(motion), motion, EffortVariables::kAny, pointer, faults);
}

void check_body_load(const json& load, const std::string& pointer, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  check_fields(load, load_fields(), pointer, faults);
  const EffortKeys &force = force_or_torque(engine::Motion::kTranslation),
                   &moment = force_or_torque(engine::Motion::kRotation);
  if (load.contains(force.key) == load.contains(moment.key))
    faults.push_back({pointer, "must have either a force_n or a torque_n_m"});
  for (const EffortKeys* const effort : {&force, &moment})
    if (load.contains(effort->key))
      check_effort(load.at(effort->key), *effort, engine::Motion::kRotation, EffortVariables::kTime,
                   pointer + pointer_token(effort->key), faults);
  if (faults.size() == before && direction_of(load).isZero(0.0))
    faults.push_back({pointer + "/direction", "must not be 0"});
}

engine::LinkageLoad read_body_load(const std::string& name, const json& load) {
  const EffortKeys &force = force_or_torque(engine::Motion::kTranslation),
                   &moment = force_or_torque(engine::Motion::kRotation);
  const bool is_force = load.contains(force.key);
  engine::LinkageLoad read{.name = name, .body = load.at("body").get<std::string>(), .law = {}};
  if (load.contains("at_m")) {
    const auto at = load.at("at_m").get<std::array<double, 3>>();
    read.at = {at[0], at[1], at[2]};
  }
  (is_force ? read.force : read.moment) = direction_of(load).stableNormalized();
  read.follows_body = load.value("follows_body", false);
  const EffortKeys& effort = is_force ? force : moment;
  read.law = read_effort(load.at(effort.key), effort, engine::Motion::kRotation).law;
  return read;
}

void check_ground_acceleration(const json& acceleration_of, const std::string& pointer,
                               std::vector<Fault>& faults) {
  check_fields(acceleration_of, ground_acceleration_fields(), pointer, faults);
  for (const auto& [axis, law] : acceleration_of.items())
    check_effort(law, acceleration(), engine::Motion::kRotation, EffortVariables::kTime,
                 pointer + pointer_token(axis), faults);
}

engine::Signal read_acceleration(const json& law) {
  return read_effort(law, acceleration(), engine::Motion::kRotation).law;
}

void check_friction(const json& friction, engine::Motion motion, const engine::RpsupParameters& defaults,
                    const std::string& pointer, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  check_fields(friction, friction_fields(motion), pointer, faults);
  const bool by_reaction = friction.value("by_reaction", json()) == true;
  if (!by_reaction && !friction.contains("normal_force_n"))
    faults.push_back({pointer + "/normal_force_n", "is missing, and so is by_reaction"});
  if (!by_reaction && friction.contains("length_mm"))
    faults.push_back({pointer + "/length_mm", "belongs to friction with by_reaction"});
  if (faults.size() > before) return;
  const auto given = read_friction(friction, motion, defaults);
  if (given && given->law.law == engine::FrictionLaw::kAmbrosio && given->law.v_1 <= given->law.v_0)
    faults.push_back({pointer + "/friction_velocity_1_m_s", "must be above friction_velocity_0_m_s"});
}

std::optional<engine::JointFriction> read_friction(const json& friction, engine::Motion motion,
                                                   const engine::RpsupParameters& defaults) {
  const auto law = engine::make_clearance(clearance_parameters(friction, defaults)).friction;
  if (!law) return std::nullopt;
  return engine::JointFriction{
      .law = *law,
      .normal_force = friction.value("normal_force_n", 0.0),
      .radius = slides(motion) ? 1.0 : friction.at("radius_mm").get<double>() / kMmPerM,
      .by_reaction = friction.value("by_reaction", false),
      .length = friction.value("length_mm", 0.0) / kMmPerM};
}

engine::ForceLaw read_load(const json& load, engine::Motion motion) {
  return read_effort(load, force_or_torque(motion), motion);
}

}  // namespace jobs
