// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/actuator_fields.h"

#include <iterator>
#include <utility>

namespace jobs {
namespace {

constexpr Range kGain = above(0, 1e12);

Range range_of(const EffortKeys& effort) { return between(-effort.largest, effort.largest); }

bool is_friction_parameter(std::string_view key) {
  return key.starts_with("friction") || key.starts_with("bristle") || key.starts_with("stribeck") ||
         key.starts_with("break_away");
}

/// @param units  of the effort by the error of the position: N m/rad, N/m, V/rad, V/m
LinkageField gain_field(std::string_view key, std::string_view help, std::string_view unit) {
  return {.key = key, .range = kGain, .unit = unit, .help = help};
}

}  // namespace

const EffortKeys& force_or_torque(engine::Motion motion) {
  static constexpr EffortKeys kForce{"force_n", "mean_n", "amplitude_n", "values_n", "limit_n", "N", 1e9};
  static constexpr EffortKeys kTorque{"torque_n_m", "mean_n_m", "amplitude_n_m", "values_n_m", "limit_n_m",
                                      "N m",        1e9};
  return slides(motion) ? kForce : kTorque;
}

const EffortKeys& voltage() {
  static constexpr EffortKeys kVoltage{"voltage_v", "mean_v", "amplitude_v", "values_v", "limit_v", "V", 1e9};
  return kVoltage;
}

const EffortKeys& acceleration() {
  static constexpr EffortKeys kAcceleration{"value_m_s2", "mean_m_s2", "amplitude_m_s2", "values_m_s2", "",
                                            "m/s^2",      1e6};
  return kAcceleration;
}

LinkageFields load_fields() {
  const auto law = [](const EffortKeys& effort, std::string_view help) {
    return effort_field(effort, help, false);
  };
  return {{.key = "body", .kind = FieldKind::kBody, .help = "On which it acts", .required = true},
          {.key = "at_m",
           .kind = FieldKind::kPoint,
           .range = between(-1000, 1000),
           .unit = "m",
           .help = "Where the load acts, in the body's frame; without it its origin. The place of a moment "
                   "counts on a beam"},
          {.key = "direction",
           .kind = FieldKind::kPoint,
           .range = between(-1e6, 1e6),
           .help = "Of the force, or of the moment's axis; of any length",
           .required = true},
          {.key = "follows_body",
           .kind = FieldKind::kBoolean,
           .help = "True: the direction is in the body's frame and turns with it; without it the ground's"},
          law(force_or_torque(engine::Motion::kTranslation), "A force: a number, or a law over time"),
          law(force_or_torque(engine::Motion::kRotation), "A moment: a number, or a law over time")};
}

LinkageFields ground_acceleration_fields() {
  LinkageFields fields;
  for (const std::string_view axis : {"x", "y", "z"})
    fields.push_back({.key = axis,
                      .kind = FieldKind::kEffort,
                      .range = range_of(acceleration()),
                      .unit = acceleration().unit,
                      .help = "A number, or a law over time; without it 0"});
  return fields;
}

TableVariables table_variables(engine::Motion motion) {
  return slides(motion) ? TableVariables{.positions = "positions_m", .velocities = "velocities_m_s"}
                        : TableVariables{.positions = "positions_rad", .velocities = "velocities_rad_s"};
}

LinkageField effort_field(const EffortKeys& effort, std::string_view help, bool required) {
  return {.key = effort.key,
          .kind = FieldKind::kEffort,
          .range = range_of(effort),
          .unit = effort.unit,
          .help = help,
          .required = required};
}

LinkageFields effort_fields(const EffortKeys& effort, std::string_view law, engine::Motion motion,
                            EffortVariables variables) {
  LinkageFields fields{{.key = "law",
                        .kind = FieldKind::kWord,
                        .help = "Kind of law",
                        .required = true,
                        .words = {std::begin(kEffortLaws), std::end(kEffortLaws)}}};
  const auto add = [&](LinkageField field) { fields.push_back(std::move(field)); };
  if (law == "constant") {
    add({.key = effort.key,
         .range = range_of(effort),
         .unit = effort.unit,
         .help = "At all times",
         .required = true});
  } else if (law == "harmonic") {
    add({.key = effort.mean, .range = range_of(effort), .unit = effort.unit, .help = "Without it 0"});
    add({.key = effort.amplitude,
         .range = range_of(effort),
         .unit = effort.unit,
         .help = "Of the sine over time",
         .required = true});
    add({.key = "frequency_hz",
         .range = above(0, 1e5),
         .unit = "Hz",
         .help = "Of the sine",
         .required = true});
    add({.key = "phase_rad",
         .range = between(-1e6, 1e6),
         .unit = "rad",
         .help = "Of the sine; without it 0"});
  } else if (law == "table") {
    const TableVariables of = table_variables(motion);
    const auto add_variable = [&](std::string_view key, Range range, std::string_view unit,
                                  std::string_view help) {
      add({.key = key, .kind = FieldKind::kNumbers, .range = range, .unit = unit, .help = help, .fewest = 2});
    };
    add_variable(of.times, between(-3600, 7200), "s", "The table is over time: rising by 1e-6 s or more");
    if (variables == EffortVariables::kAny) {
      add_variable(of.positions, between(-1e6, 1e6), slides(motion) ? "m" : "rad",
                   "The table is over the coordinate: rising by 1e-6 or more");
      add_variable(of.velocities, between(-1e6, 1e6), slides(motion) ? "m/s" : "rad/s",
                   "The table is over the coordinate's rate: rising by 1e-6 or more");
    }
    add({.key = effort.values,
         .kind = FieldKind::kNumbers,
         .range = range_of(effort),
         .unit = effort.unit,
         .help = "One for each; constant before the first and after the last",
         .required = true,
         .fewest = 2});
    add({.key = "interpolation",
         .kind = FieldKind::kWord,
         .help = "Between them; without it monotone_cubic, which has no extremes between them",
         .words = {"linear", "monotone_cubic"}});
  }
  return fields;
}

LinkageFields controller_fields(const EffortKeys& effort, std::string_view controlled,
                                engine::Motion motion) {
  const bool of_position = controlled == "position", electric = effort.unit == "V", slide = slides(motion);
  const auto unit = [&](std::string_view volts_m, std::string_view volts_rad, std::string_view newtons,
                        std::string_view newton_metres) {
    return electric ? (slide ? volts_m : volts_rad) : slide ? newtons : newton_metres;
  };
  const std::string_view by_position = unit("V/m", "V/rad", "N/m", "N m/rad"),
                         by_rate = unit("V s/m", "V s/rad", "N s/m", "N m s/rad"),
                         by_integral = unit("V/(m s)", "V/(rad s)", "N/(m s)", "N m/(rad s)");
  LinkageFields fields{
      {.key = "controlled",
       .kind = FieldKind::kWord,
       .help = "The quantity whose error is controlled: that of the coordinate or of its rate",
       .required = true,
       .words = {std::begin(kControlled), std::end(kControlled)}},
      {.key = "target",
       .kind = FieldKind::kObject,
       .help = "The motion that is asked for: any law of a drive",
       .required = true},
      gain_field("proportional", "Gain of the error", of_position ? by_position : by_rate),
      gain_field("integral", "Gain of the error's integral, which begins with 0",
                 of_position ? by_integral : by_position),
  };
  if (of_position) fields.push_back(gain_field("derivative", "Gain of the error's rate", by_rate));
  fields.push_back({.key = effort.limit,
                    .range = above(0, 1e9),
                    .unit = effort.unit,
                    .help = "Largest magnitude of the output; without it there is none"});
  fields.push_back({.key = "tracking_time_s",
                    .range = above(0, 3600),
                    .unit = "s",
                    .help = "In which the integral follows an output at its limit (anti-windup by "
                            "back-calculation); without it proportional / integral, or 1 s without a "
                            "proportional gain"});
  return fields;
}

LinkageFields motor_fields(engine::Motion motion) {
  return {
      {.key = "voltage_v",
       .kind = FieldKind::kEffort,
       .range = range_of(voltage()),
       .unit = "V",
       .help = "Of the supply: a number, or a law over time"},
      {.key = "controller",
       .kind = FieldKind::kObject,
       .help = "Gives the voltage, in the place of voltage_v"},
      {.key = "torque_constant_n_m_a",
       .range = above(0, 1e6),
       .unit = "N m/A",
       .help = "Torque by current, and back-EMF by speed of the rotor in V s/rad",
       .required = true},
      {.key = "resistance_ohm",
       .range = above(0, 1e6),
       .unit = "ohm",
       .help = "Of the winding",
       .required = true},
      {.key = "inductance_h",
       .range = between(1e-7, 1e3),
       .unit = "H",
       .help = "Of the winding",
       .required = true},
      {.key = slides(motion) ? "gear_ratio_rad_m" : "gear_ratio",
       .range = above(0, 1e6),
       .unit = slides(motion) ? "rad/m" : "",
       .help = slides(motion) ? "Turn of the rotor by displacement of the coordinate"
                              : "Turns of the rotor by turns of the coordinate; without it 1",
       .required = slides(motion)},
      {.key = "gear_efficiency",
       .range = above(0, 1),
       .help = "Part of the power that the gear passes on; "
               "without it 1"},
      {.key = "rotor_inertia_kg_m2",
       .range = between(0, 1e6),
       .unit = "kg m^2",
       .help = "Of the rotor about its axis; without it 0"},
      {.key = "viscous_friction_n_m_s_rad",
       .range = between(0, 1e6),
       .unit = "N m s/rad",
       .help = "Of the rotor; without it 0"},
      {.key = "dry_friction_n_m",
       .range = between(0, 1e6),
       .unit = "N m",
       .help = "Of the rotor: the torque against its turning; without it 0"},
      {.key = "reversal_velocity_rad_s",
       .range = between(1e-6, 1e6),
       .unit = "rad/s",
       .help = "Speed of the rotor about which dry friction and the gear's losses change their direction, "
               "as its hyperbolic tangent; without it 0.1"},
  };
}

LinkageFields friction_fields(engine::Motion motion) {
  LinkageFields fields{{.key = "normal_force_n",
                        .range = between(0, 1e9),
                        .unit = "N",
                        .help = "With which the surfaces are pressed together beside what the joint bears; "
                                "needed without by_reaction, 0 with it"},
                       {.key = "by_reaction",
                        .kind = FieldKind::kBoolean,
                        .help = "True: the force that the joint bears presses the surfaces, too"},
                       {.key = "length_mm",
                        .range = above(0, 1e6),
                        .unit = "mm",
                        .help = "With by_reaction: length of the bearing or guide, about the joint's place; "
                                "at its ends it bears the moment, too. Without it moments press nothing"}};
  if (!slides(motion))
    fields.push_back({.key = "radius_mm",
                      .range = above(0, 1e5),
                      .unit = "mm",
                      .help = "At which the surfaces slide: that of the pin",
                      .required = true});
  for (const LinkageField& field : clearance_fields())
    if (is_friction_parameter(field.key)) fields.push_back(field);
  return fields;
}

std::vector<std::string_view> actuator_words(engine::Motion motion) {
  return {slides(motion) ? "force" : "torque", "controller", "dc_motor"};
}

LinkageField actuator_field(engine::Motion motion) {
  return {.key = "actuator",
          .kind = FieldKind::kWord,
          .help = "What moves the coordinate by a force",
          .required = true,
          .words = actuator_words(motion)};
}

}  // namespace jobs
