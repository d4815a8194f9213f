// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/path_unit.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "jobs/linkages/actuator_fields.h"
#include "jobs/linkages/linkage_clearance.h"
#include "jobs/linkages/linkage_fields.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/requests/parameter_path.h"

namespace jobs {
namespace {

using UnitsOfKeys = std::map<std::string_view, std::string_view>;

/// A key that has several units, as the gain of a controller, has none here.
void add_units(const LinkageFields& fields, UnitsOfKeys& units) {
  for (const LinkageField& field : fields) {
    const auto [entry, is_new] = units.emplace(field.key, field.unit);
    if (!is_new && entry->second != field.unit) entry->second = "";
  }
}

void add_effort_units(const EffortKeys& effort, engine::Motion motion, UnitsOfKeys& units) {
  add_units({effort_field(effort, "", false)}, units);
  for (const std::string_view law : kEffortLaws)
    add_units(effort_fields(effort, law, motion, EffortVariables::kAny), units);
  for (const std::string_view controlled : kControlled)
    add_units(controller_fields(effort, controlled, motion), units);
}

void add_motion_units(engine::Motion motion, UnitsOfKeys& units) {
  for (const LinkageFields& fields : {freedom_fields(motion), motor_fields(motion), friction_fields(motion)})
    add_units(fields, units);
  for (const std::string_view law : kLaws) add_units(drive_fields(motion, law), units);
  for (const EffortKeys& effort : {force_or_torque(motion), voltage(), acceleration()})
    add_effort_units(effort, motion, units);
}

const UnitsOfKeys& units_of_keys() {
  static const UnitsOfKeys units = [] {
    UnitsOfKeys made;
    for (const LinkageFields& fields :
         {linkage_fields(), body_fields(), beam_fields(), joint_fields(), spring_fields(), clearance_fields(),
          block_fields(), cross_fields(), load_fields(), ground_acceleration_fields()})
      add_units(fields, made);
    for (const auto motion : {engine::Motion::kTranslation, engine::Motion::kRotation})
      add_motion_units(motion, made);
    return made;
  }();
  return units;
}

/// "linkage.bodies.rod.centre_of_mass_m.0" -> "centre_of_mass_m"
std::string_view key_of_path(std::string_view path) {
  std::string_view last = path.substr(path.rfind('.') + 1);
  const bool is_index = std::ranges::all_of(last, [](unsigned char c) { return std::isdigit(c) != 0; });
  return is_index ? key_of_path(path.substr(0, path.size() - last.size() - 1)) : last;
}

}  // namespace

std::optional<std::string> find_path_unit(std::string_view name) {
  if (const ParameterInfo* const info = find_parameter(name)) return std::string(info->unit);
  if (!is_path_in_description(name) && !name.starts_with("links.")) return std::nullopt;
  const auto found = units_of_keys().find(key_of_path(name));
  return found == units_of_keys().end() ? "" : std::string(found->second);
}

}  // namespace jobs
