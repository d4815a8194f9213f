// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/check_linkage.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "jobs/linkages/linkage_actuator.h"
#include "jobs/linkages/linkage_beam.h"
#include "jobs/linkages/linkage_clearance.h"
#include "jobs/linkages/linkage_drive.h"
#include "jobs/linkages/linkage_fields.h"
#include "jobs/linkages/linkage_joint.h"
#include "jobs/linkages/linkage_size.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/rpsup_drives.h"

namespace jobs {
namespace {

using engine::JointKind;
using nlohmann::json;

constexpr std::size_t kMostBodies = 200;
constexpr std::size_t kMostJoints = 400;
constexpr std::size_t kMostSprings = 400;
constexpr std::size_t kMostLoads = 400;
constexpr std::size_t kMostAccelerometers = 400;
constexpr std::size_t kLongestKey = 32;

class LinkageChecker {
 public:
  LinkageChecker(const json& given, const engine::RpsupParameters& defaults, std::vector<Fault>& faults)
      : given_(given), defaults_(defaults), faults_(faults), before_(faults.size()) {}

  std::optional<std::vector<std::string>> check() {
    check_fields(given_, linkage_fields(), "/linkage", faults_);
    if (failed()) return std::nullopt;
    check_bodies();
    check_joints();
    if (given_.contains("springs")) check_springs();
    if (given_.contains("loads")) check_loads();
    if (given_.contains("accelerometers")) check_accelerometers();
    if (given_.contains("ground_acceleration_m_s2"))
      check_ground_acceleration(given_.at("ground_acceleration_m_s2"), "/linkage/ground_acceleration_m_s2",
                                faults_);
    if (failed()) return std::nullopt;
    check_size();
    sort_joints();
    return failed() ? std::nullopt : std::optional(std::move(order_));
  }

 private:
  [[nodiscard]] bool failed() const { return faults_.size() > before_; }
  void fault(std::string pointer, std::string detail) {
    faults_.push_back({std::move(pointer), std::move(detail)});
  }

  [[nodiscard]] static bool is_plain_name(const std::string& name) {
    return !name.empty() && name.size() <= kLongestKey &&
           std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
           std::all_of(name.begin(), name.end(), [](char c) {
             return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
           });
  }

  /// @returns whether every entry can be looked at
  bool check_names(const char* key, std::size_t most) {
    const std::size_t before = faults_.size();
    const json& named = given_.at(key);
    const std::string pointer = "/linkage" + pointer_token(key);
    if (named.empty() || named.size() > most)
      fault(pointer, "must have one entry or more, at most " + std::to_string(most));
    for (const auto& [name, value] : named.items()) {
      if (!is_plain_name(name))
        fault(pointer + pointer_token(name),
              "a name is a letter, then letters, digits and _, at most 32 in all");
      if (!value.is_object()) fault(pointer + pointer_token(name), "must be an object");
    }
    return faults_.size() == before;
  }

  void check_bodies() {
    if (given_.at("bodies").contains(engine::kGroundName))
      fault("/linkage/bodies/ground", "is the name of the fixed frame");
    if (!check_names("bodies", kMostBodies)) return;
    for (const auto& [name, body] : given_.at("bodies").items())
      check_body(body, "/linkage/bodies" + pointer_token(name));
  }

  void check_body(const json& body, const std::string& pointer) {
    const std::size_t before = faults_.size();
    check_fields(body, body_fields(), pointer, faults_);
    if (body.contains("inertia_kg_m2") && body.contains("inertia_about_origin_kg_m2"))
      fault(pointer + "/inertia_about_origin_kg_m2", "and inertia_kg_m2 say the same: give one of them");
    if (faults_.size() > before || !body.contains("beam")) return;
    for (const char* const key : {"centre_of_mass_m", "inertia_kg_m2", "inertia_about_origin_kg_m2"})
      if (body.contains(key)) fault(pointer + pointer_token(key), "is that of the beam");
    check_fields(body.at("beam"), beam_fields(), pointer + "/beam", faults_);
    if (faults_.size() == before) check_beam(body.at("beam"), defaults_, pointer + "/beam", faults_);
  }

  void check_joints() {
    if (!check_names("joints", kMostJoints)) return;
    for (const auto& [name, joint] : given_.at("joints").items())
      check_joint(joint, "/linkage/joints" + pointer_token(name));
    std::set<std::string> names;
    for (const auto& [name, joint] : given_.at("joints").items()) {
      if (has_cross(joint) && given_.at("bodies").contains(name + std::string(kCrossEnding)))
        fault("/linkage/joints" + pointer_token(name),
              "has a cross, which is a body " + name + std::string(kCrossEnding) + ": there is one already");
      for (const std::string& coordinate : coordinate_names(name, joint))
        if (!names.insert(coordinate).second)
          fault("/linkage/joints" + pointer_token(name),
                "has a coordinate " + coordinate + ", and so has another joint");
    }
  }

  void check_springs() {
    if (!check_names("springs", kMostSprings)) return;
    for (const auto& [name, spring] : given_.at("springs").items())
      check_spring(name, spring, "/linkage/springs" + pointer_token(name));
  }

  void check_loads() {
    if (!check_names("loads", kMostLoads)) return;
    for (const auto& [name, load] : given_.at("loads").items()) {
      const std::string pointer = "/linkage/loads" + pointer_token(name);
      check_body_load(load, pointer, faults_);
      check_moving_body(load, pointer, "the ground does not yield");
    }
  }

  void check_accelerometers() {
    if (!check_names("accelerometers", kMostAccelerometers)) return;
    for (const auto& [name, one] : given_.at("accelerometers").items()) {
      const std::string pointer = "/linkage/accelerometers" + pointer_token(name);
      const std::size_t before = faults_.size();
      check_fields(one, accelerometer_fields(), pointer, faults_);
      if (faults_.size() == before && one.at("direction") == json{0, 0, 0})
        fault(pointer + "/direction", "must not be 0");
      check_moving_body(one, pointer, "the ground is at rest");
    }
  }

  /// @param reason  why the ground will not do
  void check_moving_body(const json& object, const std::string& pointer, const std::string& reason) {
    if (is_unknown_body(object, "body"))
      fault(pointer + "/body", "there is no body " + object.at("body").get<std::string>());
    else if (object.value("body", json()) == engine::kGroundName)
      fault(pointer + "/body", "must be a body: " + reason);
  }

  void check_spring(const std::string& name, const json& spring, const std::string& pointer) {
    check_fields(spring, spring_fields(), pointer, faults_);
    for (const char* const end : {"from", "to"})
      if (is_unknown_body(spring, end))
        fault(pointer + pointer_token(end), "there is no body " + spring.at(end).get<std::string>());
    if (spring.contains("to") && spring.value("from", json()) == spring.at("to"))
      fault(pointer + "/to", "must be a body other than from");
    if (!spring.contains("stiffness_n_m") && !spring.contains("damping_n_s_m") &&
        !spring.contains("drag_n_s_m"))
      fault(pointer, "must have a stiffness_n_m, a damping_n_s_m or a drag_n_s_m");
    check_drag(spring, pointer);
    for (const auto& [other, joint] : given_.at("joints").items())
      if (other == name) fault(pointer, "needs a name that is no joint's: there is a joint " + other);
  }

  /// Drag between bodies that turn as one would brake them although nothing moves between them.
  void check_drag(const json& spring, const std::string& pointer) {
    if (spring.contains("drag_n_s_m") && spring.value("from", json()) != engine::kGroundName &&
        spring.value("to", json()) != engine::kGroundName)
      fault(pointer + "/drag_n_s_m", "needs the ground at one end of the spring");
  }

  [[nodiscard]] bool is_unknown_body(const json& object, const char* key) const {
    if (!object.contains(key) || !object.at(key).is_string()) return false;
    const std::string& name = object.at(key).get_ref<const std::string&>();
    return name != engine::kGroundName && !given_.at("bodies").contains(name);
  }

  [[nodiscard]] static std::vector<std::string> coordinate_names(const std::string& name, const json& joint) {
    std::vector<std::string> names;
    if (!find_joint_kind(joint)) return names;
    if (closes_loop(joint)) {
      if (has_cross(joint)) names.push_back(name + std::string(kFirstEnding));
      return names;
    }
    for (const auto& [part, motion] : list_freedoms(joint))
      names.push_back(part.empty() ? name : name + "_" + std::string(part));
    return names;
  }

  void check_joint(const json& joint, const std::string& pointer) {
    const auto kind = find_joint_kind(joint);
    check_keys_of_joint(joint, kind, pointer);
    check_body_name(joint, "from", pointer);
    check_body_name(joint, "to", pointer);
    if (!kind) return;
    check_kind(joint, *kind, pointer);
    check_clearance(joint, *kind, defaults_, pointer, faults_);
    if (!closes_loop(joint)) check_freedoms(joint, *kind, pointer);
  }

  void check_keys_of_joint(const json& joint, std::optional<JointKind> kind, const std::string& pointer) {
    LinkageFields fields = joint_fields();
    json known = joint;
    if (kind && has_one_freedom(*kind))
      for (LinkageField& field : freedom_fields(freedoms_of(*kind).front().second)) {
        if (!closes_loop(joint)) fields.push_back(std::move(field));
        else if (known.erase(std::string(field.key)) > 0)
          fault(pointer + pointer_token(field.key),
                "belongs to a joint that carries its second body: have the loop cut at another joint");
      }
    check_fields(known, fields, pointer, faults_);
  }

  [[nodiscard]] static bool has_one_freedom(JointKind kind) { return freedoms_of(kind).size() == 1; }

  void check_body_name(const json& joint, const char* key, const std::string& pointer) {
    if (!joint.contains(key) || !joint.at(key).is_string()) return;
    const std::string& name = joint.at(key).get_ref<const std::string&>();
    if (name == engine::kGroundName) {
      if (std::string_view(key) == "to" && !closes_loop(joint))
        fault(pointer + "/to", "must be a body: nothing carries the ground");
    } else if (is_unknown_body(joint, key)) {
      fault(pointer + pointer_token(key), "there is no body " + name);
    }
  }

  [[nodiscard]] static bool has_axis(JointKind kind) {
    return kind != JointKind::kSpherical && kind != JointKind::kPlanar && kind != JointKind::kFree &&
           kind != JointKind::kWeld;
  }

  /// Faults of keys that belong to joints of another kind.
  void check_keys_of_kind(const json& joint, JointKind kind, const std::string& pointer) {
    const auto only = [&](const char* key, bool fits, const char* of) {
      if (joint.contains(key) && !fits) fault(pointer + pointer_token(key), std::string("belongs to ") + of);
    };
    const bool closes = closes_loop(joint);
    only("second_axis", kind == JointKind::kUniversal, "a universal joint");
    only("axis", has_axis(kind), "a joint with an axis");
    only("lead_mm", kind == JointKind::kScrew, "a screw");
    only("freedoms", list_freedoms(joint).size() > 1 && !closes,
         "a joint of several freedoms that carries its second body");
    only("clearance", can_have_clearance(kind),
         "a revolute, prismatic, cylindrical, universal or spherical joint");
    only("cross", has_cross(joint), "a universal joint with clearance");
    only("to_at_m", closes, "a joint that closes a loop");
    only("to_turned_deg", closes, "a joint that closes a loop");
  }

  void check_kind(const json& joint, JointKind kind, const std::string& pointer) {
    check_keys_of_kind(joint, kind, pointer);
    const bool closes = closes_loop(joint);
    const bool cannot_close =
        kind == JointKind::kScrew || kind == JointKind::kPlanar || kind == JointKind::kFree;
    if (cannot_close && closes)
      fault(pointer + "/closes_loop",
            "must be false of a screw, planar or free joint: have the loop cut at another joint");
    if (kind == JointKind::kScrew && !joint.contains("lead_mm")) fault(pointer + "/lead_mm", "is missing");
    if (kind == JointKind::kUniversal &&
        axis_word(joint, "axis", "z") == axis_word(joint, "second_axis", "y"))
      fault(pointer + "/second_axis", "must be an axis other than that of axis");
    if (closes && joint.value("from", json()) == joint.value("to", json()))
      fault(pointer + "/to", "must be a body other than from");
  }

  [[nodiscard]] static json axis_word(const json& joint, const char* key, const char* otherwise) {
    return joint.value(key, json(otherwise));
  }

  void check_freedoms(const json& joint, JointKind kind, const std::string& pointer) {
    if (has_one_freedom(kind)) {
      check_freedom_drive(joint, freedoms_of(kind).front().second, pointer);
      check_reaction_friction(joint, joint, pointer);
    }
    std::vector<JointFreedom> freedoms = list_freedoms(joint);
    std::erase_if(freedoms, [](const JointFreedom& freedom) { return freedom.first.empty(); });
    if (!joint.contains("freedoms") || !joint.at("freedoms").is_object()) return;
    for (const auto& [part, freedom] : joint.at("freedoms").items()) {
      const std::string at = pointer + "/freedoms" + pointer_token(part);
      const auto found = std::ranges::find(freedoms, part, &JointFreedom::first);
      if (found == freedoms.end()) {
        std::string names;
        for (const auto& [name, motion] : freedoms) names += (names.empty() ? "" : ", ") + std::string(name);
        fault(at, names.empty() ? "the joint has no freedom" : "the freedoms of the joint are " + names);
      } else if (!freedom.is_object()) {
        fault(at, "must be an object");
      } else {
        check_fields(freedom, freedom_fields(found->second), at, faults_);
        check_freedom_drive(freedom, found->second, at);
        check_reaction_friction(joint, freedom, at);
        check_play(joint, kind, part, freedom, at);
      }
    }
  }

  /// Faults of friction by a reaction where the joint bears nothing.
  void check_reaction_friction(const json& joint, const json& freedom, const std::string& pointer) {
    if (!freedom.contains("friction") || !freedom.at("friction").is_object() ||
        freedom.at("friction").value("by_reaction", json()) != true)
      return;
    const std::string at = pointer + "/friction/by_reaction";
    if (joint.contains("clearance"))
      fault(at, "is of a joint without clearance: the surfaces of this one have friction of their own");
    else if (find_joint_kind(joint) == JointKind::kFree)
      fault(at, "is of a joint that bears something: a free one does not");
  }

  /// A joint that has no play in this job has only the freedoms of its kind.
  void check_play(const json& joint, JointKind kind, const std::string& part, const json& freedom,
                  const std::string& pointer) {
    const std::vector<JointFreedom> own = freedoms_of(kind);
    if (failed() || !joint.contains("clearance") || has_clearance(joint, defaults_) ||
        std::ranges::find(own, part, &JointFreedom::first) != own.end())
      return;
    for (const char* const key : {"drive", "load_n", "load_n_m", "friction"})
      if (freedom.contains(key))
        fault(pointer + pointer_token(key), "moves nothing: the clearance is 0, and the joint ideal");
  }

  void check_freedom_drive(const json& freedom, engine::Motion motion, const std::string& pointer) {
    const std::string load = slides(motion) ? "load_n" : "load_n_m";
    if (freedom.contains(load)) check_load(freedom.at(load), motion, pointer + pointer_token(load), faults_);
    if (freedom.contains("friction") && freedom.at("friction").is_object())
      check_friction(freedom.at("friction"), motion, defaults_, pointer + "/friction", faults_);
    if (!freedom.contains("drive") || !freedom.at("drive").is_object()) return;
    check_drive(freedom.at("drive"), motion, pointer + "/drive", faults_);
    if (is_actuator(freedom.at("drive"))) return;
    for (const char* const key :
         {"start_m", "start_rad", "start_rate_m_s", "start_rate_rad_s", "guess_m", "guess_rad"})
      if (freedom.contains(key)) fault(pointer + pointer_token(key), "is what the drive says");
  }

  void check_size() {
    std::string detail =
        describe_size_fault(size_of_linkage(given_, static_cast<std::size_t>(defaults_.rigid_elements)));
    if (!detail.empty()) fault("/linkage", std::move(detail));
  }

  /// The joint that carries each body. Faults of bodies that none carries, or more than one.
  std::map<std::string, std::string> find_carriers() {
    std::map<std::string, std::string> carried_by;
    for (const auto& [name, joint] : given_.at("joints").items()) {
      if (closes_loop(joint)) continue;
      const auto [entry, is_new] = carried_by.emplace(joint.at("to").get<std::string>(), name);
      if (!is_new)
        fault("/linkage/joints" + pointer_token(name) + "/to",
              "is carried by the joint " + entry->second +
                  " already: one of the two closes a loop (closes_loop)");
    }
    for (const auto& [name, body] : given_.at("bodies").items())
      if (!carried_by.contains(name))
        fault("/linkage/bodies" + pointer_token(name), "is carried by no joint");
    return carried_by;
  }

  /// Each joint behind the one that carries its first body; by names where that leaves a choice.
  void sort_joints() {
    const std::map<std::string, std::string> carried_by = find_carriers();
    if (failed()) return;
    add_carried(engine::kGroundName);
    for (const auto& [body, joint] : carried_by)
      if (std::ranges::find(order_, joint) == order_.end())
        fault("/linkage/joints" + pointer_token(joint) + "/from",
              "leads back to the body itself: no chain of joints carries it from the ground");
    for (const auto& [name, joint] : given_.at("joints").items())
      if (closes_loop(joint)) order_.push_back(name);
  }

  /// Chain after chain.
  void add_carried(const std::string& body) {
    for (const auto& [name, joint] : given_.at("joints").items()) {
      if (closes_loop(joint) || joint.at("from") != body) continue;
      order_.push_back(name);
      add_carried(joint.at("to").get<std::string>());
    }
  }

  const json& given_;
  const engine::RpsupParameters& defaults_;
  std::vector<Fault>& faults_;
  std::size_t before_;
  std::vector<std::string> order_;  ///< of the joints
};

}  // namespace

std::optional<std::vector<std::string>> check_linkage_json(const json& description,
                                                           const engine::RpsupParameters& defaults,
                                                           std::vector<Fault>& faults) {
  return LinkageChecker(description, defaults, faults).check();
}

}  // namespace jobs
