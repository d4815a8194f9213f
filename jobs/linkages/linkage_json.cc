// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_json.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "engine/model/rpsup.h"
#include "jobs/linkages/linkage_beam.h"
#include "jobs/linkages/linkage_drive.h"
#include "jobs/linkages/linkage_fields.h"
#include "jobs/linkages/linkage_size.h"
#include "jobs/parameters/job_spec.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/units.h"

namespace jobs {
namespace {

using engine::JointKind;
using nlohmann::json;

constexpr std::size_t kMostBodies = 200;
constexpr std::size_t kMostJoints = 400;
constexpr std::size_t kMostSprings = 400;
constexpr std::size_t kLongestKey = 32;

const std::map<std::string_view, JointKind> kKinds{{"revolute", JointKind::kRevolute},
                                                   {"prismatic", JointKind::kPrismatic},
                                                   {"cylindrical", JointKind::kCylindrical},
                                                   {"screw", JointKind::kScrew},
                                                   {"universal", JointKind::kUniversal},
                                                   {"spherical", JointKind::kSpherical},
                                                   {"planar", JointKind::kPlanar}, {"free", JointKind::kFree},
                                                   {"weld", JointKind::kWeld}};

/// The freedoms of a joint: the last part of each one's name, empty if it is the only one, and its motion.
std::vector<std::pair<std::string_view, engine::Motion>> parts_of(JointKind kind) {
  using enum engine::Motion;
  switch (kind) {
    case JointKind::kRevolute: return {{"", kRotation}};
    case JointKind::kPrismatic: return {{"", kTranslation}};
    case JointKind::kCylindrical:
    case JointKind::kScrew: return {{"slide", kTranslation}, {"turn", kRotation}};
    case JointKind::kUniversal: return {{"first", kRotation}, {"second", kRotation}};
    case JointKind::kSpherical: return {{"z", kRotation}, {"y", kRotation}, {"x", kRotation}};
    case JointKind::kPlanar: return {{"x", kTranslation}, {"y", kTranslation}, {"turn", kRotation}};
    case JointKind::kFree: return {{"x", kTranslation}, {"y", kTranslation}, {"z", kTranslation},
                                   {"turn_z", kRotation},
                                   {"turn_y", kRotation}, {"turn_x", kRotation}};
    case JointKind::kWeld: return {};
  }
  return {};
}

Eigen::Vector3d point_of(const json& object, const char* key) {
  if (!object.contains(key)) return Eigen::Vector3d::Zero();
  const auto values = object.at(key).get<std::array<double, 3>>();
  return {values[0], values[1], values[2]};
}

/// Sine and cosine, exact at quarters of a turn.
std::pair<double, double> sine_and_cosine(double degrees) {
  const double quarters = degrees / 90.0;
  if (quarters != std::round(quarters)) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return {std::sin(angle), std::cos(angle)};
  }
  constexpr std::array<double, 4> kSines{0.0, 1.0, 0.0, -1.0};
  const auto quarter = static_cast<std::size_t>(((std::lround(quarters) % 4) + 4) % 4);
  return {kSines[quarter], kSines[(quarter + 1) % 4]};
}

/// R_z(c) R_y(b) R_x(a) of (a, b, c).
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& degrees) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (const int axis : {2, 1, 0}) {
    const auto [s, c] = sine_and_cosine(degrees[axis]);
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    turn(i, i) = turn(j, j) = c;
    turn(j, i) = s;
    turn(i, j) = -s;
    R = R * turn;
  }
  return R;
}

engine::Axis axis_of(const json& joint, const char* key, char otherwise) {
  const char letter = joint.value(key, std::string(1, otherwise))[0];
  return static_cast<engine::Axis>(letter - 'x');
}

/// The turn that brings one axis where another one is: the three follow each other round.
Eigen::Matrix3d turn_to(engine::Axis from, engine::Axis to) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  const int by = static_cast<int>(to) - static_cast<int>(from) + 3;
  for (int i = 0; i < 3; ++i) R((i + by) % 3, i) = 1.0;
  return R;
}

Eigen::Matrix3d inertia_of(const json& values) {
  const auto at = [&](std::size_t i) { return i < values.size() ? values[i].get<double>() : 0.0; };
  Eigen::Matrix3d I;
  I << at(0), at(3), at(4), at(3), at(1), at(5), at(4), at(5), at(2);
  return I;
}

class LinkageReader {
 public:
  LinkageReader(const json& given, const engine::RpsupParameters& defaults, std::vector<Fault>& faults)
      : given_(given), defaults_(defaults), faults_(faults), before_(faults.size()) {}

  std::optional<engine::Linkage> read() {
    check_fields(given_, linkage_fields(), "/linkage", faults_);
    if (failed()) return std::nullopt;
    check_bodies();
    check_joints();
    if (given_.contains("springs")) check_springs();
    if (failed()) return std::nullopt;
    check_size();
    sort_joints();
    if (failed()) return std::nullopt;
    return make();
  }

 private:
  [[nodiscard]] bool failed() const { return faults_.size() > before_; }
  void fault(std::string pointer, std::string detail) {
    faults_.push_back({std::move(pointer), std::move(detail)});
  }

  /// @returns whether every entry can be looked at
  bool check_names(const char* key, std::size_t most) {
    const std::size_t before = faults_.size();
    const json& named = given_.at(key);
    const std::string pointer = "/linkage" + pointer_token(key);
    if (named.empty() || named.size() > most)
      fault(pointer, "must have one entry or more, at most " + std::to_string(most));
    for (const auto& [name, value] : named.items()) {
      const bool plain = !name.empty() && name.size() <= kLongestKey &&
                         std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
                         std::all_of(name.begin(), name.end(), [](char c) {
                           return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
                         });
      if (!plain)
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
    for (const auto& [name, joint] : given_.at("joints").items())
      for (const std::string& coordinate : coordinate_names(name, joint))
        if (!names.insert(coordinate).second)
          fault("/linkage/joints" + pointer_token(name),
                "has a coordinate " + coordinate + ", and so has another joint");
  }

  void check_springs() {
    if (!check_names("springs", kMostSprings)) return;
    for (const auto& [name, spring] : given_.at("springs").items())
      check_spring(name, spring, "/linkage/springs" + pointer_token(name));
  }

  void check_spring(const std::string& name, const json& spring, const std::string& pointer) {
    check_fields(spring, spring_fields(), pointer, faults_);
    for (const char* const end : {"from", "to"})
      if (is_unknown_body(spring, end))
        fault(pointer + pointer_token(end), "there is no body " + spring.at(end).get<std::string>());
    if (spring.contains("to") && spring.value("from", json()) == spring.at("to"))
      fault(pointer + "/to", "must be a body other than from");
    if (!spring.contains("stiffness_n_m") && !spring.contains("damping_n_s_m"))
      fault(pointer, "must have a stiffness_n_m, a damping_n_s_m or both");
    for (const auto& [other, joint] : given_.at("joints").items())
      if (other == name || other == name + "_length")
        fault(pointer, "needs a name whose channels are no joint's: there is a joint " + other);
  }

  [[nodiscard]] bool is_unknown_body(const json& object, const char* key) const {
    if (!object.contains(key) || !object.at(key).is_string()) return false;
    const std::string& name = object.at(key).get_ref<const std::string&>();
    return name != engine::kGroundName && !given_.at("bodies").contains(name);
  }

  [[nodiscard]] static std::vector<std::string> coordinate_names(const std::string& name, const json& joint) {
    std::vector<std::string> names;
    const auto kind = joint.contains("kind") && joint.at("kind").is_string() ?
        kKinds.find(joint.at("kind").get_ref<const std::string&>()) : kKinds.end();
    if (kind == kKinds.end() || closes_loop(joint)) return names;
    for (const auto& [part, freedom] : parts_of(kind->second))
      names.push_back(part.empty() ? name : name + "_" + std::string(part));
    return names;
  }

  [[nodiscard]] static bool closes_loop(const json& joint) {
    const auto found = joint.find("closes_loop");
    return found != joint.end() && found->is_boolean() && found->get<bool>();
  }

  void check_joint(const json& joint, const std::string& pointer) {
    const json kind_word = joint.value("kind", json());
    const auto kind =
        kind_word.is_string() ? kKinds.find(kind_word.get_ref<const std::string&>()) : kKinds.end();
    LinkageFields fields = joint_fields();
    const bool single = kind != kKinds.end() && parts_of(kind->second).size() == 1 && !closes_loop(joint);
    if (single)
      for (LinkageField& field : freedom_fields(parts_of(kind->second).front().second))
        fields.push_back(std::move(field));
    check_fields(joint, fields, pointer, faults_);
    check_body_name(joint, "from", pointer);
    check_body_name(joint, "to", pointer);
    if (kind == kKinds.end()) return;
    check_kind(joint, kind->second, pointer);
    if (closes_loop(joint)) return check_clearance(joint, kind->second, pointer);
    check_freedoms(joint, kind->second, pointer);
  }

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

  void check_kind(const json& joint, JointKind kind, const std::string& pointer) {
    const auto only = [&](const char* key, bool fits, const char* of) {
      if (joint.contains(key) && !fits) fault(pointer + pointer_token(key), std::string("belongs to ") + of);
    };
    const bool closes = closes_loop(joint);
    only("second_axis", kind == JointKind::kUniversal, "a universal joint");
    const bool cannot_close =
        kind == JointKind::kScrew || kind == JointKind::kPlanar || kind == JointKind::kFree;
    only("axis",
         kind != JointKind::kSpherical && kind != JointKind::kPlanar && kind != JointKind::kFree &&
             kind != JointKind::kWeld,
         "a joint with an axis");
    only("lead_mm", kind == JointKind::kScrew, "a screw");
    only("freedoms", parts_of(kind).size() > 1 && !closes,
         "a joint of several freedoms that carries its second body");
    only("clearance", kind == JointKind::kRevolute && closes,
         "a revolute joint that closes a loop: have the loop cut there");
    only("to_at_m", closes, "a joint that closes a loop");
    only("to_turned_deg", closes, "a joint that closes a loop");
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

  void check_clearance(const json& joint, JointKind kind, const std::string& pointer) {
    if (kind != JointKind::kRevolute || !joint.contains("clearance") || !joint.at("clearance").is_object())
      return;
    const std::size_t before = faults_.size();
    check_fields(joint.at("clearance"), clearance_fields(), pointer + "/clearance", faults_);
    if (faults_.size() > before) return;
    const engine::RpsupParameters own = joint_parameters(joint.at("clearance"));
    if (own.c_r >= own.bearing_radius)
      fault(pointer + "/clearance/clearance_mm", "must be less than bearing_radius_mm, which is " +
                                                     readable_number(1e3 * own.bearing_radius) + " mm");
    if (own.youngs_modulus > 3.0 * own.shear_modulus)
      fault(pointer + "/clearance/youngs_modulus_pa",
            "must be at most 3 times shear_modulus_pa: Poisson's ratio is at most 0.5");
  }

  /// The job's own, save those that the joint has of its own.
  [[nodiscard]] engine::RpsupParameters joint_parameters(const json& clearance) const {
    JobSpec spec;
    spec.parameters = defaults_;
    for (const auto& [key, value] : clearance.items())
      find_parameter(key)->write(spec, canonical_value(*find_parameter(key), value));
    return spec.parameters;
  }

  void check_freedoms(const json& joint, JointKind kind, const std::string& pointer) {
    const auto freedoms = parts_of(kind);
    if (freedoms.size() == 1) return check_own_drive(joint, freedoms[0].second, pointer);
    if (!joint.contains("freedoms") || !joint.at("freedoms").is_object()) return;
    for (const auto& [part, freedom] : joint.at("freedoms").items()) {
      const std::string place = pointer + "/freedoms" + pointer_token(part);
      const auto found =
          std::ranges::find(freedoms, part, &std::pair<std::string_view, engine::Motion>::first);
      if (found == freedoms.end()) {
        std::string names;
        for (const auto& [name, freedom_kind] : freedoms)
          names += (names.empty() ? "" : ", ") + std::string(name);
        fault(place, names.empty() ? "the joint has no freedom" : "the freedoms of the joint are " + names);
      } else if (!freedom.is_object()) {
        fault(place, "must be an object");
      } else {
        check_fields(freedom, freedom_fields(found->second), place, faults_);
        check_own_drive(freedom, found->second, place);
      }
    }
  }

  void check_own_drive(const json& freedom, engine::Motion motion, const std::string& pointer) {
    if (!freedom.contains("drive") || !freedom.at("drive").is_object()) return;
    check_drive(freedom.at("drive"), motion, pointer + "/drive", faults_);
    for (const char* const key :
         {"start_m", "start_rad", "start_rate_m_s", "start_rate_rad_s", "guess_m", "guess_rad"})
      if (freedom.contains(key)) fault(pointer + pointer_token(key), "is what the drive says");
  }

  void check_size() {
    std::string detail =
        describe_size_fault(size_of_linkage(given_, static_cast<std::size_t>(defaults_.rigid_elements)));
    if (!detail.empty()) fault("/linkage", std::move(detail));
  }

  /// Each joint behind the one that carries its first body; by names where that leaves a choice.
  void sort_joints() {
    const json& joints = given_.at("joints");
    std::map<std::string, std::string> carried_by;
    for (const auto& [name, joint] : joints.items()) {
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
    if (failed()) return;
    add_carried(engine::kGroundName);
    for (const auto& [body, joint] : carried_by)
      if (std::ranges::find(order_, joint) == order_.end())
        fault("/linkage/joints" + pointer_token(joint) + "/from",
              "leads back to the body itself: no chain of joints carries it from the ground");
    for (const auto& [name, joint] : joints.items())
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

  [[nodiscard]] engine::Linkage make() const {
    engine::Linkage linkage;
    for (const auto& [name, body] : given_.at("bodies").items())
      linkage.bodies.push_back(make_body(name, body));
    for (const std::string& name : order_)
      linkage.joints.push_back(make_joint(name, given_.at("joints").at(name)));
    if (given_.contains("springs"))
      for (const auto& [name, spring] : given_.at("springs").items())
        linkage.springs.push_back(make_spring(name, spring));
    linkage.gravity_W = given_.contains("gravity_m_s2") ? point_of(given_, "gravity_m_s2")
                                                        : Eigen::Vector3d(0.0, -defaults_.gravity, 0.0);
    linkage.drive_rows = defaults_.drive == engine::DriveEnforcement::kBaumgarte
                             ? engine::DriveRows::kMultipliers
                             : engine::DriveRows::kEliminated;
    linkage.baumgarte_alpha = defaults_.baumgarte_alpha;
    linkage.baumgarte_beta = defaults_.baumgarte_beta;
    return linkage;
  }

  [[nodiscard]] engine::LinkageBody make_body(const std::string& name, const json& given) const {
    engine::LinkageBody body;
    body.name = name;
    body.mass = given.at("mass_kg").get<double>();
    if (given.contains("beam")) {
      body.beam = read_beam(given.at("beam"), body.mass, defaults_);
      body.elements = given.at("beam").value("elements", defaults_.rigid_elements);
      return body;
    }
    body.com = point_of(given, "centre_of_mass_m");
    if (given.contains("inertia_about_origin_kg_m2")) {
      body.inertia = inertia_of(given.at("inertia_about_origin_kg_m2"));
      return body;
    }
    if (given.contains("inertia_kg_m2")) body.inertia = inertia_of(given.at("inertia_kg_m2"));
    body.inertia +=
        body.mass * (body.com.squaredNorm() * Eigen::Matrix3d::Identity() - body.com * body.com.transpose());
    return body;
  }

  [[nodiscard]] engine::LinkageJoint make_joint(const std::string& name, const json& given) const {
    engine::LinkageJoint joint;
    joint.name = name;
    joint.kind = kKinds.at(given.at("kind").get_ref<const std::string&>());
    joint.from = given.at("from").get<std::string>();
    joint.to = given.at("to").get<std::string>();
    joint.placement = {rotation_of(point_of(given, "turned_deg")), point_of(given, "at_m")};
    joint.cut = closes_loop(given);
    if (joint.cut) {
      finish_cut(given, joint);
      return joint;
    }
    joint.axes = {axis_of(given, "axis", 'z'), axis_of(given, "second_axis", 'y')};
    joint.lead = given.value("lead_mm", 0.0) / kMmPerM / (2.0 * std::numbers::pi);
    for (const auto& [part, motion] : parts_of(joint.kind)) {
      const json own = part.empty()
                           ? given
                           : given.value("freedoms", json::object()).value(std::string(part), json::object());
      joint.freedoms.push_back(
          make_freedom(part.empty() ? name : name + "_" + std::string(part), own, motion));
    }
    return joint;
  }

  [[nodiscard]] static engine::LinkageSpring make_spring(const std::string& name, const json& given) {
    return {.name = name,
            .from = given.at("from").get<std::string>(),
            .to = given.at("to").get<std::string>(),
            .at = point_of(given, "at_m"),
            .to_at = point_of(given, "to_at_m"),
            .stiffness = given.value("stiffness_n_m", 0.0),
            .damping = given.value("damping_n_s_m", 0.0),
            .free_length = given.contains("free_length_m")
                               ? std::optional(given.at("free_length_m").get<double>())
                               : std::nullopt};
  }

  /// The engine's cut joints have their axis along z, the second one of a universal joint along the journal's
  /// x.
  void finish_cut(const json& given, engine::LinkageJoint& joint) const {
    joint.to_placement = {rotation_of(point_of(given, "to_turned_deg")), point_of(given, "to_at_m")};
    const engine::Axis axis = axis_of(given, "axis", 'z');
    joint.placement.R = joint.placement.R * turn_to(engine::Axis::kZ, axis);
    joint.to_placement.R =
        joint.to_placement.R * (joint.kind == JointKind::kUniversal
                                    ? turn_to(engine::Axis::kX, axis_of(given, "second_axis", 'y'))
                                    : turn_to(engine::Axis::kZ, axis));
    if (!given.contains("clearance")) return;
    const engine::RpsupParameters own = joint_parameters(given.at("clearance"));
    if (own.c_r > 0.0) joint.clearance = engine::make_clearance(own);
  }

  [[nodiscard]] engine::LinkageFreedom make_freedom(std::string name, const json& given,
                                                    engine::Motion motion) const {
    const auto optional = [&](const char* in_metres, const char* in_radians) {
      const char* const key = slides(motion) ? in_metres : in_radians;
      return given.contains(key) ? std::optional(given.at(key).get<double>()) : std::nullopt;
    };
    engine::LinkageFreedom freedom;
    freedom.name = std::move(name);
    freedom.guess = optional("guess_m", "guess_rad").value_or(0.0);
    freedom.start = optional("start_m", "start_rad");
    freedom.start_rate = optional("start_rate_m_s", "start_rate_rad_s");
    freedom.stiffness = optional("stiffness_n_m", "stiffness_n_m_rad").value_or(0.0);
    freedom.damping = optional("damping_n_s_m", "damping_n_m_s_rad").value_or(0.0);
    if (given.contains("drive")) freedom.drive = read_drive(given.at("drive"), motion, defaults_);
    return freedom;
  }

  const json& given_;
  const engine::RpsupParameters& defaults_;
  std::vector<Fault>& faults_;
  std::size_t before_;
  std::vector<std::string> order_;  ///< of the joints
};

json with_doubles(const json& value) {
  if (value.is_number()) return value.get<double>() + 0.0;  // -0 + 0 is +0
  if (!value.is_structured()) return value;
  json made = value;
  for (json& part : made) part = with_doubles(part);
  return made;
}

}  // namespace

bool describes_linkage(const json& parameters) {
  const auto found = parameters.find(kLinkageKey);
  return found != parameters.end() && found->is_object();
}

std::optional<engine::Linkage> read_linkage(const json& description, const engine::RpsupParameters& defaults,
                                            std::vector<Fault>& faults) {
  return LinkageReader(description, defaults, faults).read();
}

std::string pointer_of_linkage_field(std::string_view field) {
  std::string pointer = "/linkage";
  for (std::size_t start = 0; start <= field.size();) {
    const std::size_t dot = std::min(field.find('.', start), field.size());
    const std::string_view part = field.substr(start, dot - start);
    if (!part.empty())
      pointer += pointer_token(part == "mass" ? "mass_kg" : part == "inertia" ? "inertia_kg_m2" : part);
    start = dot + 1;
  }
  return pointer;
}

std::size_t count_freedoms(std::string_view kind) { return parts_of(kKinds.at(kind)).size(); }

json canonical_linkage(const json& description) { return with_doubles(description); }

}  // namespace jobs
