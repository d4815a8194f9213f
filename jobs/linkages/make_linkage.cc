// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/make_linkage.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

#include "jobs/linkages/linkage_actuator.h"
#include "jobs/linkages/linkage_beam.h"
#include "jobs/linkages/linkage_clearance.h"
#include "jobs/linkages/linkage_drive.h"
#include "jobs/linkages/linkage_fields.h"
#include "jobs/linkages/linkage_joint.h"
#include "jobs/parameters/rpsup_drives.h"
#include "jobs/parameters/units.h"

namespace jobs {
namespace {

using engine::JointKind;
using nlohmann::json;

Eigen::Vector3d point_of(const json& object, const char* key) {
  if (!object.contains(key)) return Eigen::Vector3d::Zero();
  const auto values = object.at(key).get<std::array<double, 3>>();
  return {values[0], values[1], values[2]};
}

/// Sine and cosine, exact at multiples of 90 degrees.
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
    Eigen::Matrix3d R_axis = Eigen::Matrix3d::Identity();
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    R_axis(i, i) = R_axis(j, j) = c;
    R_axis(j, i) = s;
    R_axis(i, j) = -s;
    R = R * R_axis;
  }
  return R;
}

Eigen::Matrix3d inertia_of(const json& values) {
  const auto at = [&](std::size_t i) { return i < values.size() ? values[i].get<double>() : 0.0; };
  Eigen::Matrix3d I;
  I << at(0), at(3), at(4), at(3), at(1), at(5), at(4), at(5), at(2);
  return I;
}

class LinkageMaker {
 public:
  LinkageMaker(const json& given, const engine::RpsupParameters& defaults)
      : given_(given), defaults_(defaults) {}

  [[nodiscard]] engine::Linkage make(const std::vector<std::string>& order) const {
    engine::Linkage linkage;
    for (const auto& [name, body] : given_.at("bodies").items())
      linkage.bodies.push_back(make_body(name, body));
    for (const std::string& name : order)
      add_joint(name, given_.at("joints").at(name), linkage);
    add_springs_and_loads(linkage);
    if (given_.contains("accelerometers"))
      for (const auto& [name, accelerometer] : given_.at("accelerometers").items())
        linkage.accelerometers.push_back(make_accelerometer(name, accelerometer));
    set_gravity_and_ground(linkage);
    set_drive_rows(linkage);
    return linkage;
  }

 private:
  void add_springs_and_loads(engine::Linkage& linkage) const {
    if (given_.contains("springs"))
      for (const auto& [name, spring] : given_.at("springs").items())
        linkage.springs.push_back(make_spring(name, spring));
    if (given_.contains("loads"))
      for (const auto& [name, load] : given_.at("loads").items())
        linkage.loads.push_back(read_body_load(name, load));
  }

  void set_gravity_and_ground(engine::Linkage& linkage) const {
    if (given_.contains("ground_acceleration_m_s2"))
      for (const auto& [axis, law] : given_.at("ground_acceleration_m_s2").items())
        linkage.ground_acceleration[static_cast<std::size_t>(axis[0] - 'x')] = read_acceleration(law);
    linkage.gravity_W = given_.contains("gravity_m_s2") ? point_of(given_, "gravity_m_s2")
                                                        : Eigen::Vector3d(0.0, -defaults_.gravity, 0.0);
  }

  void set_drive_rows(engine::Linkage& linkage) const {
    linkage.drive_rows = defaults_.drive == engine::DriveEnforcement::kBaumgarte
                             ? engine::DriveRows::kMultipliers
                             : engine::DriveRows::kEliminated;
    linkage.baumgarte_alpha = defaults_.baumgarte_alpha;
    linkage.baumgarte_beta = defaults_.baumgarte_beta;
  }

  [[nodiscard]] engine::LinkageBody make_body(const std::string& name, const json& given) const {
    engine::LinkageBody body;
    body.name = name;
    body.mass = given.at("mass_kg").get<double>();
    if (given.contains("beam")) set_beam(given.at("beam"), body);
    else set_inertia(given, body);
    return body;
  }

  /// A beam of one element is a rigid body with the beam's inertia.
  void set_beam(const json& given, engine::LinkageBody& body) const {
    const engine::UniformBeam beam = read_beam(given, body.mass, defaults_);
    body.elements = given.value("elements", defaults_.rigid_elements);
    if (body.elements > 1) {
      body.beam = beam;
    } else {
      body.com.x() = 0.5 * beam.length;
      body.inertia = engine::calc_beam_inertia(beam).asDiagonal();
    }
  }

  static void set_inertia(const json& given, engine::LinkageBody& body) {
    body.com = point_of(given, "centre_of_mass_m");
    if (given.contains("inertia_about_origin_kg_m2")) {
      body.inertia = inertia_of(given.at("inertia_about_origin_kg_m2"));
      return;
    }
    if (given.contains("inertia_kg_m2")) body.inertia = inertia_of(given.at("inertia_kg_m2"));
    body.inertia +=
        body.mass * (body.com.squaredNorm() * Eigen::Matrix3d::Identity() - body.com * body.com.transpose());
  }

  void add_joint(const std::string& name, const json& given, engine::Linkage& linkage) const {
    if (has_cross(given)) add_crossed(name, given, linkage);
    else linkage.joints.push_back(make_joint(name, given));
  }

  [[nodiscard]] engine::LinkageJoint make_joint(const std::string& name, const json& given) const {
    engine::LinkageJoint joint = start_joint(name, given);
    if (has_clearance(given, defaults_))
      joint.clearance = read_clearance(given.at("clearance"), joint.kind, defaults_);
    if (joint.cut) {
      place_cut(given, joint);
      return joint;
    }
    joint.axes = {read_axis(given, "axis", 'z'), read_axis(given, "second_axis", 'y')};
    joint.lead = given.value("lead_mm", 0.0) / kMmPerM / (2.0 * std::numbers::pi);
    joint.freedoms = make_freedoms(joint, given);
    return joint;
  }

  [[nodiscard]] std::vector<engine::LinkageFreedom> make_freedoms(const engine::LinkageJoint& joint,
                                                                  const json& given) const {
    std::vector<engine::LinkageFreedom> freedoms;
    for (const auto& [part, motion] : joint.clearance ? list_freedoms(given) : freedoms_of(joint.kind)) {
      const std::string key(part);
      freedoms.push_back(part.empty()
                             ? make_freedom(joint.name, given, motion)
                             : make_freedom(joint.name + "_" + key, freedom_of(given, key), motion));
    }
    return freedoms;
  }

  [[nodiscard]] static engine::LinkageJoint start_joint(const std::string& name, const json& given) {
    engine::LinkageJoint joint;
    joint.name = name;
    joint.kind = find_joint_kind(given).value();
    joint.from = given.at("from").get<std::string>();
    joint.to = given.at("to").get<std::string>();
    joint.placement = {rotation_of(point_of(given, "turned_deg")), point_of(given, "at_m")};
    joint.cut = closes_loop(given);
    return joint;
  }

  [[nodiscard]] static json freedom_of(const json& joint, const std::string& key) {
    return joint.value("freedoms", json::object()).value(key, json::object());
  }

  /// A universal joint with clearance: two revolute joints with the cross between them, the first of which
  /// carries the cross.
  void add_crossed(const std::string& name, const json& given, engine::Linkage& linkage) const {
    const std::string cross = name + std::string(kCrossEnding);
    linkage.bodies.push_back(make_body(cross, given.at("cross")));
    linkage.joints.push_back(make_first_of_cross(name, given, cross));
    linkage.joints.push_back(make_second_of_cross(name, given, cross));
  }

  /// A revolute joint between the bodies of the universal one, with its clearance.
  [[nodiscard]] engine::LinkageJoint start_revolute(const std::string& name, const json& given) const {
    engine::LinkageJoint joint = start_joint(name, given);
    joint.kind = JointKind::kRevolute;
    if (has_clearance(given, defaults_))
      joint.clearance = read_clearance(given.at("clearance"), joint.kind, defaults_);
    return joint;
  }

  [[nodiscard]] engine::LinkageJoint make_first_of_cross(const std::string& name, const json& given,
                                                         const std::string& cross) const {
    engine::LinkageJoint first = start_revolute(name + std::string(kFirstEnding), given);
    first.to = cross;
    first.cut = false;
    first.axes[0] = read_axis(given, "axis", 'z');
    add_freedoms(first, freedom_of(given, "first"));
    return first;
  }

  [[nodiscard]] engine::LinkageJoint make_second_of_cross(const std::string& name, const json& given,
                                                          const std::string& cross) const {
    engine::LinkageJoint second = start_revolute(name + std::string(kSecondEnding), given);
    second.from = cross;
    second.placement = {};
    second.axes[0] = read_axis(given, "second_axis", 'y');
    if (second.cut) place_cut_axis(given, second.axes[0], second);
    else add_freedoms(second, freedom_of(given, "second"));
    return second;
  }

  /// Freedoms of a joint of a cross, with clearance or without. It is in no description; `shown` stands for
  /// its own, to name the freedoms with play.
  void add_freedoms(engine::LinkageJoint& joint, const json& given) const {
    const json shown{{"kind", "revolute"}, {"axis", std::string(1, "xyz"[static_cast<int>(joint.axes[0])])},
                     {"clearance", json::object()}};
    for (const auto& [part, motion] : joint.clearance ? list_freedoms(shown) : freedoms_of(joint.kind))
      joint.freedoms.push_back(part.empty() ? make_freedom(joint.name, given, motion)
                                            : make_freedom(joint.name + "_" + std::string(part),
                                                           json::object(), motion));
  }

  static void place_cut_axis(const json& given, engine::Axis axis, engine::LinkageJoint& joint) {
    joint.to_placement = {rotation_of(point_of(given, "to_turned_deg")), point_of(given, "to_at_m")};
    joint.placement.R = joint.placement.R * engine::rotation_between(engine::Axis::kZ, axis);
    joint.to_placement.R = joint.to_placement.R * engine::rotation_between(engine::Axis::kZ, axis);
  }

  [[nodiscard]] static engine::LinkageSpring make_spring(const std::string& name, const json& given) {
    return {.name = name,
            .from = given.at("from").get<std::string>(),
            .to = given.at("to").get<std::string>(),
            .at = point_of(given, "at_m"),
            .to_at = point_of(given, "to_at_m"),
            .stiffness = given.value("stiffness_n_m", 0.0),
            .damping = given.value("damping_n_s_m", 0.0),
            .drag = given.value("drag_n_s_m", 0.0),
            .free_length = given.contains("free_length_m")
                               ? std::optional(given.at("free_length_m").get<double>())
                               : std::nullopt};
  }

  [[nodiscard]] static engine::LinkageAccelerometer make_accelerometer(const std::string& name,
                                                                       const json& given) {
    return {.name = name,
            .body = given.at("body").get<std::string>(),
            .at = point_of(given, "at_m"),
            .direction = point_of(given, "direction").stableNormalized(),
            .follows_body = given.value("follows_body", true),
            .shows_gravity = given.value("shows_gravity", true)};
  }

  /// The engine's cut joints have their axis along z, the second one of a universal joint along the journal's
  /// x.
  static void place_cut(const json& given, engine::LinkageJoint& joint) {
    const engine::Axis axis = read_axis(given, "axis", 'z');
    place_cut_axis(given, axis, joint);
    if (joint.kind != JointKind::kUniversal) return;
    joint.to_placement.R = rotation_of(point_of(given, "to_turned_deg")) *
                           engine::rotation_between(engine::Axis::kX, read_axis(given, "second_axis", 'y'));
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
    set_drive_and_forces(given, motion, freedom);
    return freedom;
  }

  void set_drive_and_forces(const json& given, engine::Motion motion, engine::LinkageFreedom& freedom) const {
    if (given.contains("drive") && is_actuator(given.at("drive")))
      freedom.actuator = read_actuator(given.at("drive"), motion, defaults_);
    else if (given.contains("drive"))
      freedom.drive = read_drive(given.at("drive"), motion, defaults_);
    if (const char* const load = slides(motion) ? "load_n" : "load_n_m"; given.contains(load))
      freedom.load = read_load(given.at(load), motion);
    if (given.contains("friction"))
      freedom.friction = read_friction(given.at("friction"), motion, defaults_);
  }

  const json& given_;
  const engine::RpsupParameters& defaults_;
};

}  // namespace

engine::Linkage make_linkage(const json& description, const engine::RpsupParameters& defaults,
                             const std::vector<std::string>& order) {
  return LinkageMaker(description, defaults).make(order);
}

}  // namespace jobs
