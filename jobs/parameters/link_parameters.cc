// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/link_parameters.h"

#include <algorithm>
#include <utility>

#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/units.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr std::string_view kLinksPointer = "/links";

/// The keys on which the default mass and inertia of a link depend; empty: none.
struct RodKeys {
  std::string_view length, diameter, inner_diameter;
};
constexpr std::array<RodKeys, engine::kLinkCount> kRodKeys{
    {{"crank_length_m", "crank_diameter_mm", "crank_inner_diameter_mm"},
     {"rod_length_m", "rod_diameter_mm", "rod_inner_diameter_mm"},
     {"coupler_length_m", "coupler_diameter_mm", ""},
     {"", "", ""},
     {"cross_length_mm", "cross_diameter_mm", "cross_inner_diameter_mm"}}};
constexpr std::size_t kCross = 4;                  ///< lies along its z axis, and may have no length
constexpr double kTableLengthOfCross_m = 0.1;      ///< of the tube with the table's mass and moments

/// Axis along which a link lies.
std::size_t axis_of(std::size_t link) { return link == kCross ? 2 : 0; }

double length_of(std::size_t link, const json& completed) {
  const std::string_view key = kRodKeys[link].length;
  if (key.empty()) return 0.0;
  return completed.at(key).get<double>() / (link == kCross ? kMmPerM : 1.0);
}

double table_length_of(std::size_t link) {
  return link == kCross ? kTableLengthOfCross_m
                        : default_value(*find_parameter(kRodKeys[link].length)).get<double>();
}

/// Ratios of a link's section to that of the table's link: areas, and squares of the radius of gyration.
struct SectionRatio {
  double area = 1.0, radius_squared = 1.0;
};

std::string link_pointer(std::string_view link, std::string_view part) {
  return std::string(kLinksPointer) + pointer_token(link) + (part.empty() ? "" : pointer_token(part));
}

void collect_moment_faults(const json& moments, const std::string& pointer, std::vector<Fault>& faults) {
  if (!moments.is_array() || moments.size() != 3) {
    faults.push_back(
        {pointer, "must be a list of three moments [I_x, I_y, I_z] about the link's frame origin, each " +
                      kInertiaRange.text() + " kg m^2"});
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::string detail = describe_number_fault(kInertiaRange, "kg m^2", moments[axis]);
    if (!detail.empty()) faults.push_back({pointer + pointer_token(std::to_string(axis)), std::move(detail)});
  }
}

void collect_part_faults(std::string_view link, const json& parts, std::vector<Fault>& faults) {
  constexpr std::array<std::string_view, 2> kParts{kMassKey, kInertiaKey};
  if (!parts.is_object()) {
    faults.push_back({link_pointer(link, ""), "must be an object of mass_kg and inertia_kg_m2"});
    return;
  }
  for (const auto& [part, value] : parts.items()) {
    const std::string pointer = link_pointer(link, part);
    if (part == kMassKey) {
      std::string detail = describe_number_fault(kMassRange, "kg", value);
      if (!detail.empty()) faults.push_back({pointer, std::move(detail)});
    } else if (part == kInertiaKey) {
      collect_moment_faults(value, pointer, faults);
    } else {
      faults.push_back({pointer, describe_unknown_key(part, kParts)});
    }
  }
}

double default_number(std::string_view key) { return default_value(*find_parameter(key)).get<double>(); }

SectionRatio section_ratio(const RodKeys& keys, const json& completed) {
  const double outer = number_at(completed, keys.diameter), outer_0 = default_number(keys.diameter);
  if (keys.inner_diameter.empty())
    return {(outer / outer_0) * (outer / outer_0), (outer / outer_0) * (outer / outer_0)};
  const double inner = number_at(completed, keys.inner_diameter),
               inner_0 = default_number(keys.inner_diameter);
  return {(outer * outer - inner * inner) / (outer_0 * outer_0 - inner_0 * inner_0),
          (outer * outer + inner * inner) / (outer_0 * outer_0 + inner_0 * inner_0)};
}

/// Mass and moments of the uniform rod or tube that a link is.
engine::LinkInertia default_rod(std::size_t link, double length, const json& given, const json& completed) {
  const engine::LinkInertia table = engine::RpsupParameters{}.links[link];
  const SectionRatio section = section_ratio(kRodKeys[link], completed);
  const double mass = given.contains(kMassKey) ? number_at(given, kMassKey)
                                               : table.mass * (length / table_length_of(link)) * section.area;
  const double axial =
      table.inertia[static_cast<Eigen::Index>(axis_of(link))] * (mass / table.mass) * section.radius_squared;
  engine::LinkInertia rod = engine::beam_inertia(mass, length, axial);
  if (link == kCross) std::swap(rod.inertia[0], rod.inertia[2]);
  return rod;
}

engine::LinkInertia default_link(std::size_t link, const json& given, const json& completed) {
  if (const double length = length_of(link, completed); length > 0.0)
    return default_rod(link, length, given, completed);
  engine::LinkInertia table = engine::RpsupParameters{}.links[link];
  if (!given.contains(kMassKey)) return table;
  const double mass = number_at(given, kMassKey);
  return {mass, table.inertia * (mass / table.mass)};
}

json complete_link(std::size_t link, const json& given, const json& completed) {
  const engine::LinkInertia filled = default_link(link, given, completed);
  json moments = json::array({filled.inertia.x(), filled.inertia.y(), filled.inertia.z()});
  if (given.contains(kInertiaKey)) {
    for (std::size_t axis = 0; axis < 3; ++axis) moments[axis] = given.at(kInertiaKey)[axis].get<double>();
  }
  return {{kMassKey, filled.mass}, {kInertiaKey, std::move(moments)}};
}

/// @returns whether three moments are those of some body; equal sums pass in spite of rounding (thin plates
/// have them)
bool is_possible(const std::array<double, 3>& moments) {
  constexpr double kRounding = 1e-9;
  const double sum = moments[0] + moments[1] + moments[2];
  return std::all_of(moments.begin(), moments.end(),
                     [&](double moment) { return moment > 0.0 && 2.0 * moment <= sum * (1.0 + kRounding); });
}

/// Fault of the moments of a link that no body has; empty if some body has them.
std::string describe_inertia_fault(std::size_t i, const json& completed) {
  const json& link = completed.at("links").at(kLinkNames[i]);
  auto moments = link.at(kInertiaKey).get<std::array<double, 3>>();
  if (!is_possible(moments))
    return "no body has these moments: each must be at most the sum of the other two";
  const double to_centre = 0.5 * length_of(i, completed);
  if (!(to_centre > 0.0)) return "";
  const double steiner = link.at(kMassKey).get<double>() * to_centre * to_centre;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axis != axis_of(i)) moments[axis] -= steiner;
  if (is_possible(moments)) return "";
  const std::string across = i == kCross ? "I_x and I_y" : "I_y and I_z";
  return "no body has these moments: about the centre of mass, in the middle of the link, " + across +
         " are less by m (l/2)^2 = " + readable_number(steiner) +
         " kg m^2, and each must be positive and at most the sum of the other two";
}

}  // namespace

std::vector<Fault> find_link_faults(const json& given) {
  if (!given.is_object())
    return {{std::string(kLinksPointer),
             "must be an object with a key for each link: \"1,1\", \"1,2\", \"1,3\", \"2,1\", \"2,2\""}};
  std::vector<Fault> faults;
  for (const auto& [link, parts] : given.items()) {
    if (std::find(kLinkNames.begin(), kLinkNames.end(), link) == kLinkNames.end()) {
      faults.push_back({link_pointer(link, ""),
                        "unknown link; the links are \"1,1\", \"1,2\", \"1,3\", \"2,1\", \"2,2\""});
    } else {
      collect_part_faults(link, parts, faults);
    }
  }
  return faults;
}

json complete_links(const json& given, const json& completed) {
  json links = json::object();
  for (std::size_t i = 0; i < kLinkNames.size(); ++i) {
    links[kLinkNames[i]] = complete_link(i, given.value(kLinkNames[i], json::object()), completed);
  }
  return links;
}

std::vector<Fault> find_inertia_faults(const json& completed) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < kLinkNames.size(); ++i) {
    std::string detail = describe_inertia_fault(i, completed);
    if (!detail.empty()) faults.push_back({link_pointer(kLinkNames[i], kInertiaKey), std::move(detail)});
  }
  return faults;
}

void write_links(const json& links, engine::RpsupParameters& parameters) {
  for (std::size_t i = 0; i < kLinkNames.size(); ++i) {
    const json& link = links.at(kLinkNames[i]);
    parameters.links[i].mass = link.at(kMassKey).get<double>();
    const auto moments = link.at(kInertiaKey).get<std::array<double, 3>>();
    parameters.links[i].inertia = {moments[0], moments[1], moments[2]};
  }
}

}  // namespace jobs
