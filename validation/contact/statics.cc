// SPDX-License-Identifier: Apache-2.0
// A journal held still in the bearing, tilted or shifted along its axis: forces and moments by hand.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "engine/clearance/clearance_joint.h"
#include "validation/contact/parts.h"
#include "validation/contact/sliding_mass.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kClearance = 0.25e-3;  // [m]
constexpr double kHalfLength = 10e-3;   // [m]

/// Force and moment about the journal's centre.
struct Load {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();

  void add(const Eigen::Vector3d& r, const Eigen::Vector3d& f) {
    force += f;
    moment += r.cross(f);
  }
};

/// The engine's load on a journal at rest, in the bearing's frame.
Load engine_load(const ClearanceParameters& parameters, const Eigen::Vector3d& p, const Eigen::Matrix3d& R) {
  ClearanceJoint joint(parameters);
  JournalMotion journal;
  journal.p_bj = p;
  journal.R_bj = R;
  std::vector<double> bristles(static_cast<std::size_t>(joint.bristle_count()));
  std::vector<double> rates(bristles.size());
  (void)joint.follow(journal, 0.0, bristles.data());
  ContactLoad load;
  (void)joint.calc(journal, bristles.data(), rates.data(), load);
  return {load.force, load.moment};
}

ClearanceParameters two_element_levels() {
  ClearanceParameters joint = one_ring(kClearance);
  joint.n_r = 2;
  return joint;
}

Eigen::Matrix3d turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

void add_check(Findings& findings, const std::string& what, const std::string& reference, double found,
               double expected, double relative, const std::string& unit, const std::string& why) {
  findings.checks.push_back(
      compare(what, reference, found, expected, relative * std::abs(expected), unit, why));
}

/// Force of a ring along x. @param offset  of the journal's axis at the ring, along x, [m]
double press_ring(double offset) {
  const double depth = std::abs(offset) - kClearance;
  return depth > 0.0 ? -std::copysign(0.5 * two_element_levels().K * std::pow(depth, 1.5), offset) : 0.0;
}

/// Tilt about y in the plane of the offset: the rings are at x +- 10 mm sin(tilt), and press along x.
void add_tilt_in_plane(Findings& findings, const char* name, double x, double tilt) {
  const double upper = press_ring(x + kHalfLength * std::sin(tilt));
  const double lower = press_ring(x - kHalfLength * std::sin(tilt));
  const Load load = engine_load(two_element_levels(), {x, 0.0, 0.0}, turn(tilt, Eigen::Vector3d::UnitY()));
  const std::string reference = "statics: K / 2 delta^1.5 of each ring, at its arm of 10 mm cos(tilt)";
  const std::string why = "rounding of the offset, 1e-19 m in 1e-6 m, and of the sine";
  const std::string at = std::string(", journal tilted in the plane of its offset, ") + name;
  if (upper + lower != 0.0)
    add_check(findings, "transverse force" + at, reference, load.force.x(), upper + lower, 1e-9, "N", why);
  else
    findings.checks.push_back(
        limit("transverse force" + at, "statics: none", load.force.norm(), 1e-9, "N", why));
  add_check(findings, "moment" + at, reference, load.moment.y(),
            (upper - lower) * kHalfLength * std::cos(tilt), 1e-9, "N m", why);
}

/// Tilt about x with an offset along x: the rings press at equal depth, in directions that open like
/// scissors.
void add_tilt_across(Findings& findings) {
  const double x = kClearance - 1e-6;
  const double tilt = 4e-3;
  const double y = kHalfLength * std::sin(tilt);  // the ring at +z goes to -y
  const double distance = std::hypot(x, y);
  const double force = 0.5 * two_element_levels().K * std::pow(distance - kClearance, 1.5);
  const Load load = engine_load(two_element_levels(), {x, 0.0, 0.0}, turn(tilt, Eigen::Vector3d::UnitX()));
  const std::string reference = "statics: K / 2 delta^1.5 of each ring against its own offset (x, -+y)";
  const std::string why = "rounding of the offset, 1e-19 m in 1e-6 m";
  add_check(findings, "force along the offset, journal tilted across it", reference, load.force.x(),
            -2.0 * force * x / distance, 1e-9, "N", why);
  findings.checks.push_back(limit("force across the offset, journal tilted across it",
                                  "statics: the rings' shares cancel", load.force.y(), 1e-9, "N",
                                  "rounding"));
  // Arms (0, -+y, +-10 mm cos) and forces (-f x, +-f y, 0) / distance: M_x = -(r_z f_y) twice.
  add_check(findings, "moment that rights a journal tilted across its offset", reference, load.moment.x(),
            -2.0 * kHalfLength * std::cos(tilt) * force * y / distance, 1e-9, "N m", why);
}

/// All points of all rings of elements, written out: one at rho from the bearing's axis is pressed with s
/// (rho - r_b) towards the axis.
Load press_on_elements(const ClearanceParameters& joint, const Eigen::Vector3d& p, const Eigen::Matrix3d& R) {
  const double pitch = 2.0 * std::numbers::pi / joint.n_ce;
  const double stiffness =
      joint.K / joint.n_r * 3.0 * std::sqrt(joint.c_r) / (4.0 * std::numbers::sqrt2) * pitch;
  const double r_b = 5e-3;
  const double r_j = r_b - kClearance;
  Load load;
  for (const double z : {-kHalfLength, kHalfLength})
    for (int k = 0; k < joint.n_ce; ++k) {
      const Eigen::Vector3d r = R * Eigen::Vector3d(r_j * std::cos(pitch * k), r_j * std::sin(pitch * k), z);
      const double x = p.x() + r.x();
      const double y = p.y() + r.y();
      const double rho = std::hypot(x, y);
      if (rho > r_b) load.add(r, -stiffness * (rho - r_b) / rho * Eigen::Vector3d(x, y, 0.0));
    }
  return load;
}

/// Rings of 180 elements on a tilted journal whose first element points anywhere.
void add_tilted_elements(Findings& findings) {
  ClearanceParameters joint = two_element_levels();
  joint.form = RadialForm::kElements;
  joint.n_ce = 180;
  const Eigen::Matrix3d turned = turn(0.3, Eigen::Vector3d::UnitZ());
  struct Tilted {
    const char* name;
    Eigen::Vector3d p;
    Eigen::Matrix3d R;
  };
  for (const auto& [name, p, R] :
       {Tilted{"tilt of 1 mrad in the plane of the offset, one ring 8 um deep",
               {kClearance - 2e-6, 0.0, 0.0},
               turn(1e-3, Eigen::Vector3d::UnitY())},
        Tilted{"tilt of 4 mrad across the offset, rings 2 um deep",
               {kClearance - 1e-6, 0.0, 0.0},
               turn(4e-3, Eigen::Vector3d::UnitX())},
        Tilted{"tilt of 26 mrad about an oblique axis, rings 10 um deep on opposite sides",
               {1e-6, -2e-6, 0.0},
               turn(26e-3, Eigen::Vector3d(0.6, 0.8, 0.0))}}) {
    const Load found = engine_load(joint, p, R * turned);
    const Load expected = press_on_elements(joint, p, R * turned);
    const std::string reference =
        "statics of all 360 points: s (rho - r_b), s = K / 2 * 3 sqrt(c_r) / (4 sqrt 2) * 2 pi / n_ce, "
        "towards the axis";
    const std::string why =
        "rounding of distances of 5 mm, 1e-18 m, in depths of 1e-6 m; relative to the magnitude";
    findings.checks.push_back(limit(std::string("force on rings of 180 elements, ") + name, reference,
                                    (found.force - expected.force).norm() / expected.force.norm(), 1e-10, "1",
                                    why));
    findings.checks.push_back(limit(std::string("moment on rings of 180 elements, ") + name, reference,
                                    (found.moment - expected.moment).norm() / expected.moment.norm(), 1e-10,
                                    "1", why));
  }
}

ClearanceParameters faces_only(double c_a) {
  ClearanceParameters joint = one_ring(kClearance);
  joint.c_a = c_a;
  joint.K_a = 1e8;
  return joint;
}

/// All points of both faces, by hand: a point at height +-(z - (10 mm + c_a)) presses along z with K_a / 8 a
/// metre.
Load press_on_faces(double c_a, double z, double tilt) {
  const double radius = 5e-3 - kClearance;
  Load load;
  for (const double side : {1.0, -1.0})
    for (int k = 0; k < 8; ++k) {
      const double angle = 0.25 * std::numbers::pi * k;
      const double x_j = radius * std::cos(angle);
      const double y_j = radius * std::sin(angle);
      const double z_j = side * kHalfLength;
      const Eigen::Vector3d r(x_j, y_j * std::cos(tilt) - z_j * std::sin(tilt),
                              y_j * std::sin(tilt) + z_j * std::cos(tilt));
      const double depth = side * (z + r.z()) - (kHalfLength + c_a);
      if (depth > 0.0) load.add(r, {0.0, 0.0, -side * 1e8 / 8.0 * depth});
    }
  return load;
}

void add_upright_levels(Findings& findings) {
  const double force = two_element_levels().K * std::pow(2e-6, 1.5);
  for (const int levels : {1, 2, 3, 5}) {
    ClearanceParameters joint = two_element_levels();
    joint.n_r = levels;
    const Load load = engine_load(joint, {kClearance + 2e-6, 0.0, 0.0}, Eigen::Matrix3d::Identity());
    add_check(findings, "force of an upright journal 2 um deep, " + std::to_string(levels) + " levels",
              "K delta^1.5, shared by the levels", -load.force.x(), force, 1e-9, "N",
              "rounding of the offset");
  }
}

Check compare_inside_clearance() {
  const Load inside =
      engine_load(two_element_levels(), {0.9 * kClearance, 0.0, 0.0}, turn(1e-3, Eigen::Vector3d::UnitY()));
  return limit(
      "force and moment inside the clearance: tilt of 1 mrad, rings 15 um and 35 um short of the bore",
      "none", inside.force.norm() + inside.moment.norm(), 0.0, "N", "no contact");
}

constexpr const char* kDepthRounding = "rounding of 10 mm in the depth";

/// Load on an upright journal. @param z  of its place along the axis, [m]
Load face_load_upright(double c_a, double z) {
  return engine_load(faces_only(c_a), {0.0, 0.0, z}, Eigen::Matrix3d::Identity());
}

/// Load on a journal tilted about x.
Load face_load_tilted(double c_a, double z, double tilt) {
  return engine_load(faces_only(c_a), {0.0, 0.0, z}, turn(tilt, Eigen::Vector3d::UnitX()));
}

void add_face_depths(Findings& findings, double c_a) {
  const std::string at = ", axial clearance " + number(1e6 * c_a) + " um";
  for (const double beyond : {1e-6, -1e-6, 3e-6})
    add_check(findings,
              "axial force, journal " + number(1e6 * std::abs(beyond)) +
                  " um beyond the clearance towards " + (beyond > 0.0 ? "+z" : "-z") + at,
              "-K_a (z - c_a) at one face",
              face_load_upright(c_a, beyond + std::copysign(c_a, beyond)).force.z(), -1e8 * beyond, 1e-9, "N",
              kDepthRounding);
}

void add_faces_without_depth(Findings& findings) {
  const Load free = face_load_upright(5e-6, 4.999e-6);
  findings.checks.push_back(limit("axial force 1 nm short of the axial clearance of 5 um", "none",
                                  free.force.norm() + free.moment.norm(), 0.0, "N", "no contact"));
  findings.checks.push_back(limit("axial force of an upright journal in the middle, no axial clearance",
                                  "none: both faces just touch", face_load_upright(0.0, 0.0).force.norm(),
                                  0.0, "N", "touching without depth is no contact"));
}

struct TiltedFaces {
  const char* name;
  double c_a, z, tilt;  ///< [m], [m], [rad]
};

void add_tilted_faces(Findings& findings, const TiltedFaces& faces) {
  const auto& [name, c_a, z, tilt] = faces;
  const Load found = face_load_tilted(c_a, z, tilt);
  const Load expected = press_on_faces(c_a, z, tilt);
  const std::string reference = "statics of 16 points on both faces, K_a / 8 each";
  add_check(findings, std::string("restoring moment of the faces, ") + name, reference, found.moment.x(),
            expected.moment.x(), 1e-8, "N m", kDepthRounding);
  if (z != 0.0)
    add_check(findings, std::string("axial force of the faces, ") + name, reference, found.force.z(),
              expected.force.z(), 1e-8, "N", kDepthRounding);
}

void add_small_tilt(Findings& findings) {
  const double radius = 5e-3 - kClearance;
  const double small = 1e-6;
  add_check(findings, "restoring moment of the faces, no axial clearance, over a small tilt of 1 urad",
            "-K_a r_j^2 / 2: half of each face's eight points, sum of sin^2 = 2",
            face_load_tilted(0.0, 0.0, small).moment.x() / small, -0.5 * 1e8 * radius * radius, 1e-5,
            "N m/rad", "second order in the tilt: L_b / r_j times 1e-6");
}

}  // namespace

Findings compute_tilted_journal() {
  Findings findings;
  add_tilt_in_plane(findings, "both rings in contact, 3 and 1 um deep", kClearance + 2e-6,
                    std::asin(1e-6 / kHalfLength));
  add_tilt_in_plane(findings, "one ring in contact, 2 um deep", kClearance - 8e-6,
                    std::asin(1e-5 / kHalfLength));
  add_tilt_in_plane(findings, "rings on opposite sides, 2 um deep: a couple", 0.0,
                    std::asin((kClearance + 2e-6) / kHalfLength));
  add_tilt_across(findings);
  add_tilted_elements(findings);
  add_upright_levels(findings);
  findings.checks.push_back(compare_inside_clearance());
  return findings;
}

Findings compute_axial_faces() {
  Findings findings;
  for (const double c_a : {0.0, 5e-6}) add_face_depths(findings, c_a);
  add_faces_without_depth(findings);
  add_tilted_faces(findings, {"no axial clearance, tilt 0.1 mrad", 0.0, 0.0, 1e-4});
  add_tilted_faces(findings, {"no axial clearance, 0.2 um towards +z, tilt 0.1 mrad", 0.0, 0.2e-6, 1e-4});
  add_tilted_faces(findings, {"axial clearance 5 um, 2 um towards -z, tilt 1 mrad", 5e-6, -2e-6, 1e-3});
  add_small_tilt(findings);
  return findings;
}

}  // namespace validation
