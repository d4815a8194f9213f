// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_joint.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string>

#include "jobs/parameters/job_spec.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

using engine::JointKind;
using nlohmann::json;

const std::map<std::string_view, JointKind> kKinds{{"revolute", JointKind::kRevolute},
                                                   {"prismatic", JointKind::kPrismatic},
                                                   {"cylindrical", JointKind::kCylindrical},
                                                   {"screw", JointKind::kScrew},
                                                   {"universal", JointKind::kUniversal},
                                                   {"spherical", JointKind::kSpherical},
                                                   {"planar", JointKind::kPlanar}, {"free", JointKind::kFree},
                                                   {"weld", JointKind::kWeld}};

constexpr std::array<std::string_view, 3> kSlides{"slide_x", "slide_y", "slide_z"};
constexpr std::array<std::string_view, 3> kTurns{"turn_x", "turn_y", "turn_z"};

/// 0, 1 or 2; z unless the joint names another axis.
std::size_t axis_index(const json& joint) {
  const auto word = joint.find("axis");
  if (word == joint.end() || !word->is_string()) return 2;
  const std::string& axis = word->get_ref<const std::string&>();
  return axis == "x" ? 0 : axis == "y" ? 1 : 2;
}

/// The first freedom of a joint's own that is of this motion; without one, a further freedom.
JointFreedom own_or_further(const std::vector<JointFreedom>& own, engine::Motion motion,
                            std::string_view further) {
  const auto found = std::ranges::find(own, motion, &JointFreedom::second);
  return {found != own.end() ? found->first : further, motion};
}

/// The six freedoms of a joint with clearance. @param axis  0, 1 or 2
std::vector<JointFreedom> list_freedoms_with_play(JointKind kind, std::size_t axis) {
  using enum engine::Motion;
  const std::vector<JointFreedom> own = freedoms_of(kind);
  std::vector<JointFreedom> all;
  for (const std::string_view slide : kSlides) all.push_back({slide, kTranslation});
  all[axis] = own_or_further(own, kTranslation, kSlides[axis]);
  if (kind == JointKind::kSpherical) {
    all.insert(all.end(), own.begin(), own.end());
    return all;
  }
  all.push_back(own_or_further(own, kRotation, kTurns[axis]));
  for (const std::size_t i : {2, 1, 0})
    if (i != axis) all.push_back({kTurns[i], kRotation});
  return all;
}

}  // namespace

std::optional<JointKind> find_joint_kind(const json& joint) {
  const auto word = joint.find("kind");
  if (word == joint.end() || !word->is_string()) return std::nullopt;
  const auto kind = kKinds.find(word->get_ref<const std::string&>());
  return kind == kKinds.end() ? std::nullopt : std::optional(kind->second);
}

std::vector<JointFreedom> freedoms_of(JointKind kind) {
  using enum engine::Motion;
  switch (kind) {
    case JointKind::kRevolute: return {{"", kRotation}};
    case JointKind::kPrismatic: return {{"", kTranslation}};
    case JointKind::kCylindrical:
    case JointKind::kScrew: return {{"slide", kTranslation}, {"turn", kRotation}};
    case JointKind::kUniversal: return {{"first", kRotation}, {"second", kRotation}};
    case JointKind::kSpherical: return {{"z", kRotation}, {"y", kRotation}, {"x", kRotation}};
    case JointKind::kPlanar: return {{"x", kTranslation}, {"y", kTranslation}, {"turn", kRotation}};
    case JointKind::kFree:
      return {{"x", kTranslation}, {"y", kTranslation}, {"z", kTranslation},
              {"turn_z", kRotation}, {"turn_y", kRotation}, {"turn_x", kRotation}};
    case JointKind::kWeld: return {};
  }
  return {};
}

std::vector<JointFreedom> list_freedoms(const json& joint) {
  const JointKind kind = find_joint_kind(joint).value();
  if (!joint.contains("clearance") || closes_loop(joint) || kind == JointKind::kUniversal)
    return freedoms_of(kind);
  return list_freedoms_with_play(kind, axis_index(joint));
}

engine::Axis read_axis(const json& joint, const char* key, char otherwise) {
  const char letter = joint.value(key, std::string(1, otherwise))[0];
  return static_cast<engine::Axis>(letter - 'x');
}

bool closes_loop(const json& joint) {
  const auto found = joint.find("closes_loop");
  return found != joint.end() && found->is_boolean() && found->get<bool>();
}

bool has_cross(const json& joint) {
  return find_joint_kind(joint) == JointKind::kUniversal && joint.contains("clearance");
}

engine::RpsupParameters clearance_parameters(const json& clearance, engine::RpsupParameters defaults) {
  JobSpec spec;
  spec.parameters = std::move(defaults);
  for (const auto& [key, value] : clearance.items())
    if (const ParameterInfo* parameter = find_parameter(key))
      parameter->write(spec, canonical_value(*parameter, value));
  return spec.parameters;
}

}  // namespace jobs
