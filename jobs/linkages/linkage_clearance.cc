// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

#include <Eigen/Eigenvalues>

#include "engine/clearance/normal_law.h"
#include "engine/model/rpsup.h"
#include "jobs/linkages/linkage_joint.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/units.h"
#include "jobs/parameters/wear_depth.h"

namespace jobs {
namespace {

using engine::ContactGeometry;
using engine::JointKind;
using nlohmann::json;

constexpr std::array<std::string_view, 4> kOfFaces{"axial_clearance_mm", "axial_levels", "axial_elements",
                                                   "axial_stiffness_n_m"};
constexpr std::array<std::string_view, 4> kOfBores{"contact", "radial_levels", "radial_elements",
                                                   "stiffness_law"};
constexpr double kCornerRadius = 1.0;  // [mm]

template <std::size_t count>
bool is_one_of(const std::array<std::string_view, count>& keys, std::string_view key) {
  return std::ranges::find(keys, key) != keys.end();
}

bool applies(std::string_view key, JointKind kind) {
  const bool has_faces = kind == JointKind::kRevolute || kind == JointKind::kUniversal;
  const bool has_bore = has_faces || kind == JointKind::kCylindrical;
  if (is_one_of(kOfFaces, key)) return has_faces;
  if (is_one_of(kOfBores, key)) return has_bore;
  if (key == "bearing_length_mm") return kind != JointKind::kSpherical;
  if (key == "bearing_radius_mm") return kind != JointKind::kPrismatic;
  return true;
}

bool has_field(const LinkageFields& fields, const std::string& key) {
  return std::ranges::find(fields, key, &LinkageField::key) != fields.end();
}

void check_keys(const json& clearance, const json& kind_word, JointKind kind, const std::string& pointer,
                std::vector<Fault>& faults) {
  json known = clearance;
  for (const auto& [key, value] : clearance.items()) {
    std::string detail;
    if (key == kWearKey) detail = kWearOfDescribed;
    else if (has_field(block_fields(), key) && kind != JointKind::kPrismatic)
      detail = "belongs to a prismatic joint";
    else if (has_field(clearance_fields(), key) && !applies(key, kind))
      detail = "does not belong to a " + kind_word.get<std::string>() + " joint";
    if (detail.empty()) continue;
    faults.push_back({pointer + pointer_token(key), std::move(detail)});
    known.erase(key);
  }
  check_fields(known, clearance_fields_of(kind), pointer, faults);
}

engine::ClearanceParameters make_block(const json& clearance, const engine::RpsupParameters& given) {
  const double nu = given.youngs_modulus / (2.0 * given.shear_modulus) - 1.0;
  const auto metres = [&](const char* key, double otherwise) {
    return clearance.value(key, otherwise) / kMmPerM;
  };
  engine::ClearanceParameters block = engine::make_clearance(given);
  block.geometry = ContactGeometry::kBlockInSlot;
  block.block_x = 0.5 * metres("block_width_mm", 0.0);
  block.block_y = 0.5 * metres("block_height_mm", 0.0);
  block.c_y = metres("clearance_height_mm", given.c_r * kMmPerM);
  block.K =
      given.contact_stiffness_scale *
      engine::calc_sphere_stiffness(metres("corner_radius_mm", kCornerRadius), given.youngs_modulus, nu);
  return block;
}

/// @returns whether a block can turn about any axis up to half a right angle: beyond that its corners meet
/// other walls than their own. Turned by phi it is a cos(phi) + b sin(phi) wide, most at tan(phi) = b / a.
bool can_turn_over(const engine::ClearanceParameters& block) {
  const double x = block.block_x, y = block.block_y, z = 0.5 * block.L_b;
  const double free_x = x + block.c_r, free_y = y + block.c_y;
  const auto fits = [](double a, double b, double free) {
    return (b < a ? std::hypot(a, b) : (a + b) / std::sqrt(2.0)) <= free;
  };
  return (fits(x, y, free_x) && fits(y, x, free_y)) || fits(x, z, free_x) || fits(y, z, free_y);
}

bool is_inertia_of_a_body(const json& cross) {
  const json& values = cross.at("inertia_kg_m2");
  const auto at = [&](std::size_t i) { return i < values.size() ? values[i].get<double>() : 0.0; };
  Eigen::Matrix3d I;
  I << at(0), at(3), at(4), at(3), at(1), at(5), at(4), at(5), at(2);
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(I, Eigen::EigenvaluesOnly).eigenvalues();
  const double rounding = 1e-9 * I.trace();
  return moments.minCoeff() > 0.0 && moments.sum() - 2.0 * moments.maxCoeff() >= -rounding;
}

/// Faults of the laws of contact and friction with the parameters of a joint.
void check_laws(const engine::RpsupParameters& given, JointKind kind, const std::string& pointer,
                std::vector<Fault>& faults) {
  const auto require = [&](bool holds, const char* key, const char* detail) {
    if (!holds) faults.push_back({pointer + pointer_token(key), detail});
  };
  require(given.restitution > 0.0 || engine::has_zero_restitution(given.normal_law), "restitution",
          "must be above 0 with gonthier, flores or hu_guo");
  require(given.youngs_modulus <= 3.0 * given.shear_modulus, "youngs_modulus_pa",
          "must be at most 3 times shear_modulus_pa: Poisson's ratio is at most 0.5");
  require(!applies("stiffness_law", kind) || given.stiffness_law == engine::StiffnessLaw::kHertz ||
              given.contact == engine::ContactForm::kContinuum,
          "stiffness_law", "must be hertz for contact elements: the others are laws of a whole ring");
  require(given.friction != engine::FrictionLaw::kAmbrosio || given.v_1 > given.v_0,
          "friction_velocity_1_m_s", "must be above friction_velocity_0_m_s");
}

}  // namespace

bool can_have_clearance(JointKind kind) {
  switch (kind) {
    case JointKind::kRevolute:
    case JointKind::kPrismatic:
    case JointKind::kCylindrical:
    case JointKind::kUniversal:
    case JointKind::kSpherical:
      return true;
    case JointKind::kScrew:
    case JointKind::kPlanar:
    case JointKind::kFree:
    case JointKind::kWeld:
      break;
  }
  return false;
}

LinkageFields clearance_fields_of(JointKind kind) {
  LinkageFields fields;
  for (const LinkageField& field : clearance_fields())
    if (applies(field.key, kind)) fields.push_back(field);
  if (kind == JointKind::kPrismatic)
    fields.insert(fields.end(), block_fields().begin(), block_fields().end());
  return fields;
}

const LinkageFields& block_fields() {
  static const LinkageFields fields{
      {.key = "block_width_mm",
       .range = above(0, 10'000),
       .unit = "mm",
       .help = "Width of the block, along the axis after that of the joint: x of a joint along z",
       .required = true},
      {.key = "block_height_mm",
       .range = above(0, 10'000),
       .unit = "mm",
       .help = "Height of the block, along the axis after that: y of a joint along z",
       .required = true},
      {.key = "clearance_height_mm",
       .range = above(0, 1000),
       .unit = "mm",
       .help = "Clearance at each side along the height; without it clearance_mm, which is that along the "
               "width"},
      {.key = "corner_radius_mm",
       .range = above(0, 10'000),
       .unit = "mm",
       .help = "Radius of the block's corners, of which their stiffness comes; without it 1"},
  };
  return fields;
}

const LinkageFields& cross_fields() {
  static const LinkageFields fields{
      {.key = "mass_kg", .range = above(0, 1e9), .unit = "kg", .help = "Mass of the cross", .required = true},
      {.key = "inertia_kg_m2",
       .kind = FieldKind::kInertia,
       .range = between(-1e9, 1e9),
       .unit = "kg m^2",
       .help = "Of the cross about its middle, along the axes of the joint, as that of a body",
       .required = true},
  };
  return fields;
}

void check_clearance(const json& joint, JointKind kind, const engine::RpsupParameters& defaults,
                     const std::string& pointer, std::vector<Fault>& faults) {
  if (!can_have_clearance(kind) || !joint.contains("clearance") || !joint.at("clearance").is_object()) return;
  const std::size_t before = faults.size();
  const json& clearance = joint.at("clearance");
  const std::string at = pointer + "/clearance";
  check_keys(clearance, joint.at("kind"), kind, at, faults);
  if (kind == JointKind::kUniversal && !joint.contains("cross"))
    faults.push_back({pointer + "/cross", "is missing: with clearance the cross is a body of its own"});
  if (kind == JointKind::kUniversal && joint.value("cross", json()).is_object())
    check_fields(joint.at("cross"), cross_fields(), pointer + "/cross", faults);
  if (faults.size() > before) return;
  const engine::RpsupParameters given = clearance_parameters(clearance, defaults);
  constexpr double kLeast = 1e-9 * (1.0 - 1e-12);  // [m], without the rounding of its unit
  if (given.c_r > 0.0 && given.c_r < kLeast)
    faults.push_back({at + "/clearance_mm", "must be 0 or at least 1e-6 mm"});
  if (kind == JointKind::kUniversal && !is_inertia_of_a_body(joint.at("cross")))
    faults.push_back({pointer + "/cross/inertia_kg_m2",
                      "must be that of a body: no principal moment is below 0 or larger than the sum of the "
                      "other two"});
  if (kind == JointKind::kPrismatic && can_turn_over(make_block(clearance, given)))
    faults.push_back({at + "/clearance_mm", "lets the block turn over between the walls: make it smaller"});
  if (kind != JointKind::kPrismatic && given.c_r >= given.bearing_radius)
    faults.push_back({at + "/clearance_mm", "must be less than bearing_radius_mm, which is " +
                                                readable_number(1e3 * given.bearing_radius) + " mm"});
  check_laws(given, kind, at, faults);
}

bool has_clearance(const json& joint, const engine::RpsupParameters& defaults) {
  return joint.contains("clearance") && clearance_parameters(joint.at("clearance"), defaults).c_r > 0.0;
}

engine::ClearanceParameters read_clearance(const json& clearance, JointKind kind,
                                           const engine::RpsupParameters& defaults) {
  const engine::RpsupParameters given = clearance_parameters(clearance, defaults);
  engine::ClearanceParameters made =
      kind == JointKind::kPrismatic ? make_block(clearance, given) : engine::make_clearance(given);
  if (kind == JointKind::kRevolute) return made;
  made.c_a = std::numeric_limits<double>::infinity();
  if (kind == JointKind::kCylindrical) return made;
  if (kind == JointKind::kSpherical) made.geometry = ContactGeometry::kBallInSocket;
  made.form = engine::RadialForm::kContinuum;
  made.cylinders = {};
  return made;
}

}  // namespace jobs
