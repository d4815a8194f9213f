// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_joint.h"

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

std::size_t count_freedoms(const json& joint) { return freedoms_of(find_joint_kind(joint).value()).size(); }

bool closes_loop(const json& joint) {
  const auto found = joint.find("closes_loop");
  return found != joint.end() && found->is_boolean() && found->get<bool>();
}

engine::RpsupParameters clearance_parameters(const json& clearance, engine::RpsupParameters defaults) {
  JobSpec spec;
  spec.parameters = std::move(defaults);
  for (const auto& [key, value] : clearance.items())
    find_parameter(key)->write(spec, canonical_value(*find_parameter(key), value));
  return spec.parameters;
}

}  // namespace jobs
