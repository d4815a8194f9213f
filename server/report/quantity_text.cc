// SPDX-License-Identifier: Apache-2.0
#include "server/report/quantity_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "server/report/html.h"

namespace server::report {
namespace {

/// Ends of names and their units; the first that fits counts.
constexpr std::array<std::pair<std::string_view, std::string_view>, 31> kUnitSuffixes{
    {{"stiffness_n_m", "N/m"},
     {"_n_m_s_rad", "N m s/rad"},
     {"_n_m_rad", "N m/rad"},
     {"_deg", "°"},
     {"_n_s_m", "N s/m"},
     {"_s_m", "s/m"},
     {"_1_m", "1/m"},
     {"_1_s", "1/s"},
     {"_j_m", "J m"},
     {"_rad_s2", "rad/s²"},
     {"_m_s2", "m/s²"},
     {"_rad_s", "rad/s"},
     {"_m_s", "m/s"},
     {"_n_m", "N m"},
     {"_kg_m2", "kg m²"},
     {"_kg", "kg"},
     {"_mrad", "mrad"},
     {"_rad", "rad"},
     {"_mm", "mm"},
     {"_um", "µm"},
     {"_hz", "Hz"},
     {"_gpa", "GPa"},
     {"_pa", "Pa"},
     {"_n", "N"},
     {"_j", "J"},
     {"_s", "s"},
     {"_a", "A"},
     {"_v", "V"},
     {"_w", "W"},
     {"_m", "m"},
     {"_ms", "ms"}}};

struct SplitKey {
  std::string_view name, unit;
};

SplitKey split(std::string_view key) {
  for (const auto& [suffix, unit] : kUnitSuffixes) {
    if (!key.ends_with(suffix)) continue;
    const std::size_t of_name = suffix.front() == '_' ? 0 : suffix.find('_');  // "stiffness" is a part of it
    return {key.substr(0, key.size() - suffix.size() + of_name), unit};
  }
  return {key, ""};
}

}  // namespace

std::string name_of(std::string_view key) {
  // "linkage.bodies.rod.mass" is the rod's mass.
  for (const std::string_view part : {"linkage.bodies.", "linkage.joints.", "linkage.springs.",
                                      "linkage.loads.", "linkage.accelerometers.", "linkage."})
    if (key.starts_with(part)) return name_of(key.substr(part.size()));
  std::string name(split(key).name);
  std::ranges::replace(name, '_', ' ');
  std::ranges::replace(name, '.', ' ');
  return name;
}

std::string title_of(std::string_view key) {
  std::string title = name_of(key);
  if (!title.empty()) title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  const std::string_view unit = split(key).unit;
  return unit.empty() ? title : title + " [" + std::string(unit) + "]";
}

std::string value_text(const nlohmann::json& value, std::string_view key) {
  const std::string text = cell_text(value);
  const std::string_view unit = split(key).unit;
  return value.is_number() && !unit.empty() ? text + " " + std::string(unit) : text;
}

std::string time_key_of(std::string_view peak) { return std::string(split(peak).name) + "_time_s"; }

}  // namespace server::report
