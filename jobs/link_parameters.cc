#include "jobs/link_parameters.h"

#include <algorithm>

#include "jobs/parameter_table.h"
#include "jobs/parameter_value.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr std::string_view kLinksPointer = "/links";

/// The keys on which the default mass and inertia of a link depend; empty: none.
struct RodKeys {
  std::string_view length;
  std::string_view diameter;
};
constexpr std::array<RodKeys, engine::kLinkCount> kRodKeys{
    {{"crank_length_m", ""}, {"rod_length_m", ""}, {"coupler_length_m", "coupler_diameter_mm"}, {"", ""}, {"", ""}}};

std::string link_pointer(std::string_view link, std::string_view part) {
  return std::string(kLinksPointer) + pointer_token(link) + (part.empty() ? "" : pointer_token(part));
}

void find_moment_faults(const json& moments, const std::string& pointer, std::vector<Fault>& faults) {
  if (!moments.is_array() || moments.size() != 3) {
    faults.push_back({pointer, "must be a list of three moments [I_x, I_y, I_z] about the link's frame origin, each " + kInertiaRange.text() + " kg m^2"});
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::string detail = describe_number_fault(kInertiaRange, "kg m^2", moments[axis]);
    if (!detail.empty()) faults.push_back({pointer + pointer_token(std::to_string(axis)), std::move(detail)});
  }
}

void find_part_faults(std::string_view link, const json& parts, std::vector<Fault>& faults) {
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
      find_moment_faults(value, pointer, faults);
    } else {
      faults.push_back({pointer, describe_unknown_key(part, kParts)});
    }
  }
}

double length_of(std::string_view key, const json& completed) { return completed.at(key).get<double>(); }

double ratio_to_default(std::string_view key, const json& completed) {
  return length_of(key, completed) / default_value(*find_parameter(key)).get<double>();
}

/// (d / d_0)^2; 1 for what has no diameter.
double section_ratio(const RodKeys& keys, const json& completed) {
  const double ratio = keys.diameter.empty() ? 1.0 : ratio_to_default(keys.diameter, completed);
  return ratio * ratio;
}

double default_mass(const engine::LinkInertia& table, const RodKeys& keys, const json& completed) {
  if (keys.length.empty()) return table.mass;
  return table.mass * ratio_to_default(keys.length, completed) * section_ratio(keys, completed);
}

Eigen::Vector3d default_inertia(const engine::LinkInertia& table, const RodKeys& keys, double mass, const json& completed) {
  const double mass_ratio = mass / table.mass;
  if (keys.length.empty()) return table.inertia * mass_ratio;
  return engine::rod_inertia(mass, length_of(keys.length, completed), table.inertia.x() * mass_ratio * section_ratio(keys, completed)).inertia;
}

json complete_link(std::size_t link, const json& given, const json& completed) {
  const engine::LinkInertia table = engine::RpsupParameters{}.links[link];
  const double mass = given.contains(kMassKey) ? given.at(kMassKey).get<double>() : default_mass(table, kRodKeys[link], completed);
  const Eigen::Vector3d inertia = default_inertia(table, kRodKeys[link], mass, completed);
  json moments = json::array({inertia.x(), inertia.y(), inertia.z()});
  if (given.contains(kInertiaKey)) {
    for (std::size_t axis = 0; axis < 3; ++axis) moments[axis] = given.at(kInertiaKey)[axis].get<double>();
  }
  return {{kMassKey, mass}, {kInertiaKey, std::move(moments)}};
}

/// Whether three moments are those of some body; equal sums pass in spite of rounding (thin plates have them).
bool is_possible(const std::array<double, 3>& moments) {
  constexpr double kRounding = 1e-9;
  const double sum = moments[0] + moments[1] + moments[2];
  return std::all_of(moments.begin(), moments.end(), [&](double moment) { return moment > 0.0 && 2.0 * moment <= sum * (1.0 + kRounding); });
}

}  // namespace

std::vector<Fault> find_link_faults(const json& given) {
  if (!given.is_object()) return {{std::string(kLinksPointer), "must be an object with a key for each link: \"1,1\", \"1,2\", \"1,3\", \"2,1\", \"2,2\""}};
  std::vector<Fault> faults;
  for (const auto& [link, parts] : given.items()) {
    if (std::find(kLinkNames.begin(), kLinkNames.end(), link) == kLinkNames.end()) {
      faults.push_back({link_pointer(link, ""), "unknown link; the links are \"1,1\", \"1,2\", \"1,3\", \"2,1\", \"2,2\""});
    } else {
      find_part_faults(link, parts, faults);
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
    const json& link = completed.at("links").at(kLinkNames[i]);
    auto moments = link.at(kInertiaKey).get<std::array<double, 3>>();
    const std::string pointer = link_pointer(kLinkNames[i], kInertiaKey);
    if (!is_possible(moments)) {
      faults.push_back({pointer, "no body has these moments: each must be at most the sum of the other two"});
    } else if (!kRodKeys[i].length.empty()) {
      const double to_centre = 0.5 * completed.at(kRodKeys[i].length).get<double>();
      const double steiner = link.at(kMassKey).get<double>() * to_centre * to_centre;
      moments[1] -= steiner;
      moments[2] -= steiner;
      if (!is_possible(moments)) {
        faults.push_back({pointer, "no body has these moments: about the centre of mass, in the middle of the link, I_y and I_z are less by m (l/2)^2 = " +
                                       readable_number(steiner) + " kg m^2, and each must be positive and at most the sum of the other two"});
      }
    }
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
