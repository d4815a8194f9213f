// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "engine/model/mechanism.h"
#include "jobs/linkages/linkage_fields.h"

namespace jobs {

/// A quantity that an actuator gives: a torque, a force or a voltage, with its keys.
struct EffortKeys {
  std::string_view key;  ///< of a law or of its constant value
  std::string_view mean, amplitude, values, limit;
  std::string_view unit;
  double largest;  ///< magnitude
};
[[nodiscard]] const EffortKeys& force_or_torque(engine::Motion motion);
[[nodiscard]] const EffortKeys& voltage();

/// Laws of an effort: {"law": "harmonic", ...}
inline constexpr std::string_view kEffortLaws[] = {"constant", "harmonic", "table"};
/// Keys of the variable of a table.
struct TableVariables {
  std::string_view times = "times_s", positions, velocities;
};
[[nodiscard]] TableVariables table_variables(engine::Motion motion);

/// A key whose value is a number or a law of the effort.
[[nodiscard]] LinkageField effort_field(const EffortKeys& effort, std::string_view help, bool required);

/// Keys of the laws of the ground's acceleration.
[[nodiscard]] const EffortKeys& acceleration();
[[nodiscard]] LinkageFields load_fields();
[[nodiscard]] LinkageFields ground_acceleration_fields();

enum class EffortVariables { kTime, kAny };
[[nodiscard]] LinkageFields effort_fields(const EffortKeys& effort, std::string_view law,
                                          engine::Motion motion, EffortVariables variables);

inline constexpr std::string_view kControlled[] = {"velocity", "position"};
/// @param effort      that the controller gives
/// @param controlled  "velocity" or "position"
[[nodiscard]] LinkageFields controller_fields(const EffortKeys& effort, std::string_view controlled,
                                              engine::Motion motion);
[[nodiscard]] LinkageFields motor_fields(engine::Motion motion);

/// Of the friction in a joint without clearance: its normal force, and parameters of a job that friction has.
[[nodiscard]] LinkageFields friction_fields(engine::Motion motion);

/// Words of the key "actuator": "torque" or "force", "controller", "dc_motor".
[[nodiscard]] std::vector<std::string_view> actuator_words(engine::Motion motion);
[[nodiscard]] LinkageField actuator_field(engine::Motion motion);

}  // namespace jobs
