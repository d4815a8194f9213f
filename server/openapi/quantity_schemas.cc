// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/quantity_schemas.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/linkage.h"
#include "engine/model/links.h"
#include "engine/model/rpsup_parameters.h"
#include "engine/simulate_linkage.h"
#include "jobs/measurements/channel_unit.h"

namespace server::openapi {

namespace {

Json schema_of(const engine::QuantityInfo& quantity, const ValueSchema& value) {
  Json schema = described(value(quantity), quantity.help);
  schema["x-unit"] = unit_of(quantity.key);
  if (!quantity.symbol.empty()) schema["x-symbol"] = quantity.symbol;
  return schema;
}

Json properties_of(std::span<const engine::QuantityInfo> quantities, const ValueSchema& value) {
  Json properties = Json::object();
  for (const engine::QuantityInfo& quantity : quantities)
    properties[quantity.key] = schema_of(quantity, value);
  return properties;
}

/// Regular expression of the names that a name with placeholders stands for: "^peak_.+_reaction_n$".
std::string pattern_of(std::string_view name) {
  std::string pattern = "^";
  while (!name.empty()) {
    const auto open = std::min(name.find('{'), name.size());
    pattern += name.substr(0, open);
    name.remove_prefix(open);
    if (name.empty()) break;
    pattern += ".+";
    name.remove_prefix(name.find('}') + 1);
  }
  return pattern + "$";
}

Json patterns_of(std::span<const engine::QuantityInfo> quantities, const ValueSchema& value) {
  Json patterns = Json::object();
  for (const engine::QuantityInfo& quantity : quantities) {
    Json schema = schema_of(quantity, value);
    schema["x-name"] = quantity.key;
    patterns[pattern_of(quantity.key)] = std::move(schema);
  }
  return patterns;
}

engine::LinkageJoint make_sample_joint(engine::JointKind kind, const char* from, const char* to) {
  engine::LinkageJoint joint;
  joint.name = "{joint}";
  joint.kind = kind;
  joint.from = from;
  joint.to = to;
  return joint;
}

std::vector<engine::LinkageJoint> make_sample_joints() {
  auto driven = make_sample_joint(engine::JointKind::kCylindrical, engine::kGroundName, "{body}");
  driven.freedoms.assign(2, {.name = "{coordinate}", .drive = engine::DriveLaw{}});
  auto actuated = make_sample_joint(engine::JointKind::kCylindrical, "{body}", "third");
  actuated.freedoms.assign(2, {.name = "{coordinate}",
                               .actuator = engine::DcMotor{},
                               .load = engine::ForceLaw{},
                               .friction = engine::JointFriction{}});
  auto carrying = make_sample_joint(engine::JointKind::kRevolute, engine::kGroundName, "other");
  carrying.freedoms.assign(1, {.name = "{coordinate}"});
  auto closing = make_sample_joint(engine::JointKind::kRevolute, "{body}", "other");
  closing.cut = true;
  closing.clearance = engine::ClearanceParameters{};
  return {driven, actuated, carrying, closing};
}

/// Quantities of a linkage whose names are placeholders: a body on a driven cylindrical joint, one that
/// motors move on it, another on a revolute joint; the first and the last are joined by a revolute joint with
/// clearance and by a spring.
engine::LinkageTables make_sample_tables() {
  engine::Linkage linkage;
  linkage.bodies = {{.name = "{body}"}, {.name = "other"}, {.name = "third"}};
  linkage.joints = make_sample_joints();
  linkage.springs = {{.name = "{spring}", .from = "{body}", .to = "other"}};
  const Eigen::Vector3d along = Eigen::Vector3d::UnitX();
  linkage.loads = {{.name = "{load}", .body = "other", .force = along, .law = {}},
                   {.name = "{load}", .body = "other", .moment = along, .law = {}}};
  linkage.accelerometers = {{.name = "{accelerometer}", .body = "other"}};
  return engine::linkage_tables(linkage);
}

const engine::LinkageTables& sample_tables() {
  static const engine::LinkageTables tables = [] {
    engine::LinkageTables made = make_sample_tables();
    std::erase_if(made.channels, [](const engine::QuantityInfo& channel) {
      return channel.key.starts_with("pose_other") || channel.key.starts_with("pose_third") ||
             channel.key.find("_ring_2_") != std::string::npos;
    });
    for (engine::QuantityInfo& channel : made.channels)
      if (const auto ring = channel.key.find("_ring_1_"); ring != std::string::npos)
        channel.key.replace(ring, 8, "_ring_{ring}_");
    return made;
  }();
  return tables;
}

/// Parameters of an RPSUP linkage with flexible links, wear and motors.
engine::RpsupParameters make_full_parameters() {
  engine::RpsupParameters parameters;
  parameters.cross_length = 0.1;
  for (engine::RoundLink* const link : {&parameters.crank, &parameters.rod, &parameters.cross}) {
    link->model = engine::LinkModel::kFlexible;
    link->diameter = 0.01;
  }
  parameters.crank_actuator = parameters.rod_actuator = engine::DcMotor{};
  parameters.wear_depth.assign(static_cast<std::size_t>(parameters.radial_levels),
                               std::vector<double>(16, 0.0));
  return parameters;
}

/// Channels of the RPSUP linkage with and without flexible links, wear and motors.
std::vector<engine::QuantityInfo> all_channels() {
  std::vector<engine::QuantityInfo> channels = engine::channel_table({});
  for (engine::QuantityInfo& channel : engine::channel_table(make_full_parameters())) {
    const bool known = std::ranges::find(channels, channel.key, &engine::QuantityInfo::key) != channels.end();
    if (!known && !channel.key.starts_with("pose_")) channels.push_back(std::move(channel));
  }
  return channels;
}

}  // namespace

std::string_view unit_of(std::string_view key) {
  return jobs::find_unit(key).value_or("1");
}

Json metric_properties(const ValueSchema& value) { return properties_of(engine::metric_table(), value); }

Json channel_properties(const ValueSchema& value) { return properties_of(all_channels(), value); }

Json linkage_metric_patterns(const ValueSchema& value) { return patterns_of(sample_tables().metrics, value); }

Json linkage_channel_patterns(const ValueSchema& value) {
  return patterns_of(sample_tables().channels, value);
}

}  // namespace server::openapi
