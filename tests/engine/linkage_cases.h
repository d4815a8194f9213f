// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "engine/model/linkage.h"

// Linkages of data for tests: the same loop, cut at one joint or another.

namespace engine {

/// A body whose moments are given about its centre of mass.
[[nodiscard]] inline LinkageBody make_body(const std::string& name, double mass, const Eigen::Vector3d& com, const Eigen::Vector3d& central) {
  const Eigen::Matrix3d steiner = mass * (com.squaredNorm() * Eigen::Matrix3d::Identity() - com * com.transpose());
  return {.name = name, .mass = mass, .com = com, .inertia = Eigen::Matrix3d(central.asDiagonal()) + steiner};
}

/// The turn that brings z where x is, and x where y is.
[[nodiscard]] inline Eigen::Matrix3d z_to_x() { return (Eigen::Matrix3d() << 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0).finished(); }

/// Haug's spatial slider-crank: crank about x at (0, 0.1, 0.12), a ball at its end, the rod, a pin that stays perpendicular to the slide, the
/// slider along x. Its first coordinate is the crank's angle, which starts at 6 rad/s.
/// @param cut  the joint at which the loop is cut: kSpherical, kUniversal or kPrismatic
[[nodiscard]] inline Linkage make_spatial_slider_crank(JointKind cut) {
  Linkage linkage;
  linkage.gravity_W = {0.0, 0.0, -9.81};
  linkage.bodies = {make_body("crank", 0.12, {0.0, 0.0, 0.0}, {1e-4, 1e-5, 1e-4}), make_body("slider", 2.0, {0.0, 0.0, 0.0}, {1e-4, 1e-4, 1e-4}),
                    make_body("rod", 0.5, {-0.15, 0.0, 0.0}, {4e-4, 4e-3, 4e-3})};
  linkage.joints = {{.name = "crank", .from = kGroundName, .to = "crank", .placement = {.p = {0.0, 0.1, 0.12}}, .axes = {Axis::kX, Axis::kY},
                     .freedoms = {{.name = "theta", .start = 0.0, .start_rate = 6.0}}}};
  const LinkageJoint slide{.name = "slide", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "slider", .placement = {},
                           .axes = {Axis::kX, Axis::kY}, .freedoms = {{.name = "x", .guess = 0.2}}};
  if (cut == JointKind::kSpherical) {
    linkage.joints.push_back(slide);
    linkage.joints.push_back({.name = "pin", .kind = JointKind::kUniversal, .from = "slider", .to = "rod", .placement = {},
                              .axes = {Axis::kX, Axis::kY},
                              .freedoms = {{.name = "ring", .guess = 0.5}, {.name = "pin", .guess = 0.8}}});
    linkage.joints.push_back({.name = "ball", .kind = cut, .from = "crank", .to = "rod", .placement = {.p = {0.0, 0.0, 0.08}}, .cut = true,
                              .to_placement = {.p = {-0.3, 0.0, 0.0}}});
    return linkage;
  }
  // The other way round the rod hangs on the crank, its frame at the ball, its y axis the pin's.
  linkage.bodies[2] = make_body("rod", 0.5, {0.15, 0.0, 0.0}, {4e-4, 4e-3, 4e-3});
  linkage.joints.push_back({.name = "ball", .kind = JointKind::kSpherical, .from = "crank", .to = "rod", .placement = {.p = {0.0, 0.0, 0.08}},
                            .freedoms = {{.name = "z"}, {.name = "y", .guess = 0.8}, {.name = "x_turn", .guess = 0.5}}});
  if (cut == JointKind::kUniversal) {
    linkage.joints.push_back(slide);
    linkage.joints.push_back({.name = "pin", .kind = cut, .from = "slider", .to = "rod", .placement = {.R = z_to_x()}, .cut = true,
                              .to_placement = {.R = z_to_x(), .p = {0.3, 0.0, 0.0}}});
    return linkage;
  }
  linkage.joints.push_back({.name = "pin", .kind = JointKind::kUniversal, .from = "rod", .to = "slider", .placement = {.p = {0.3, 0.0, 0.0}},
                            .axes = {Axis::kY, Axis::kX}, .freedoms = {{.name = "pin", .guess = -0.8}, {.name = "ring", .guess = -0.5}}});
  linkage.joints.push_back({.name = "slide", .kind = cut, .from = kGroundName, .to = "slider", .placement = {.R = z_to_x()}, .cut = true,
                            .to_placement = {.R = z_to_x()}});
  return linkage;
}

/// A flat four-bar linkage, free to fall. @param cut  of the joint between coupler and rocker: kRevolute or kCylindrical; kWeld: the rocker is
/// two halves, welded where the loop is cut
[[nodiscard]] inline Linkage make_four_bar(JointKind cut) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("crank", 0.2, {0.05, 0.0, 0.0}, {1e-4, 2e-4, 2e-4}), make_body("coupler", 0.3, {0.2, 0.0, 0.0}, {1e-4, 4e-3, 4e-3}),
                    make_body("lower", 0.2, {0.1, 0.0, 0.0}, {1e-4, 1e-3, 1e-3}), make_body("upper", 0.2, {-0.1, 0.0, 0.0}, {1e-4, 1e-3, 1e-3})};
  linkage.joints = {
      {.name = "crank", .from = kGroundName, .to = "crank", .placement = {}, .freedoms = {{.name = "crank", .start = 1.0, .start_rate = 3.0}}},
      {.name = "pin", .from = "crank", .to = "coupler", .placement = {.p = {0.1, 0.0, 0.0}}, .freedoms = {{.name = "pin", .guess = -0.5}}},
      {.name = "rocker", .from = kGroundName, .to = "lower", .placement = {.p = {0.4, 0.0, 0.0}}, .freedoms = {{.name = "rocker", .guess = 1.6}}}};
  const Placement coupler_end{.p = {0.4, 0.0, 0.0}};
  if (cut == JointKind::kWeld) {
    linkage.joints.push_back({.name = "end", .from = "coupler", .to = "upper", .placement = coupler_end,
                              .freedoms = {{.name = "end", .guess = 1.2}}});
    linkage.joints.push_back({.name = "joint", .kind = cut, .from = "lower", .to = "upper", .placement = {.p = {0.2, 0.0, 0.0}}, .cut = true,
                              .to_placement = {.p = {-0.1, 0.0, 0.0}}});
  } else {
    linkage.joints.push_back({.name = "joint", .kind = JointKind::kWeld, .from = "lower", .to = "upper", .placement = {.p = {0.3, 0.0, 0.0}}});
    linkage.joints.push_back({.name = "end", .kind = cut, .from = "upper", .to = "coupler", .placement = {}, .cut = true,
                              .to_placement = coupler_end});
  }
  return linkage;
}

/// A flat quick-return, free to fall: a pin of the crank turns in a block that slides along a lever. @param cut  of the joint: kRevolute, the pin,
/// or kPrismatic, the slot
[[nodiscard]] inline Linkage make_quick_return(JointKind cut) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("crank", 0.2, {0.05, 0.01, 0.0}, {1e-4, 2e-4, 2e-4}), make_body("lever", 0.5, {0.2, 0.0, 0.0}, {1e-4, 3e-2, 3e-2}),
                    make_body("block", 0.3, {0.01, 0.02, 0.0}, {1e-4, 2e-4, 2e-4})};
  linkage.joints = {
      {.name = "crank", .from = kGroundName, .to = "crank", .placement = {}, .freedoms = {{.name = "crank", .start = 1.0, .start_rate = 6.0}}},
      {.name = "lever", .from = kGroundName, .to = "lever", .placement = {.p = {0.0, -0.3, 0.0}}, .freedoms = {{.name = "lever", .guess = 1.4}}}};
  const Placement tip{.p = {0.1, 0.0, 0.0}};
  if (cut == JointKind::kRevolute) {
    linkage.joints.push_back({.name = "slot", .kind = JointKind::kPrismatic, .from = "lever", .to = "block", .placement = {},
                              .axes = {Axis::kX, Axis::kY}, .freedoms = {{.name = "slot", .guess = 0.4}}});
    linkage.joints.push_back({.name = "pin", .kind = cut, .from = "crank", .to = "block", .placement = tip, .cut = true});
  } else {
    linkage.joints.push_back({.name = "pin", .from = "crank", .to = "block", .placement = tip, .freedoms = {{.name = "pin", .guess = 0.4}}});
    linkage.joints.push_back({.name = "slot", .kind = cut, .from = "lever", .to = "block", .placement = {.R = z_to_x()}, .cut = true,
                              .to_placement = {.R = z_to_x()}});
  }
  return linkage;
}

/// A tree of all sorts whose two loops are closed by joints with clearance: a sprung carriage that slides along a rail, which turns, with a driven
/// crank on it, which a flexible rod joins to a rocker; on this an arm, with a pin in the ground. Coordinates: rail 0, carriage 1, rocker 3.
[[nodiscard]] inline Linkage make_loose_loops(const ClearanceParameters& clearance) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("rail", 0.7, {0.1, 0.02, 0.0}, {1e-3, 4e-3, 4e-3}),
                    make_body("carriage", 1.0, {0.0, 0.01, 0.0}, {1e-3, 2e-3, 3e-3}), make_body("crank", 0.2, {0.05, 0.01, 0.0}, {1e-4, 2e-4, 2e-4}),
                    make_body("rocker", 0.4, {0.15, 0.0, 0.01}, {1e-4, 3e-3, 3e-3}), make_body("arm", 0.2, {0.1, 0.0, 0.0}, {1e-4, 1e-3, 1e-3})};
  const UniformBeam rod{.length = 0.4, .mass = 0.2, .I_x = 2e-6, .EI_y = 50.0, .EI_z = 40.0, .GJ = 30.0, .damping_ratio = 0.02};
  linkage.bodies.push_back({.name = "rod", .beam = rod, .elements = 3});
  linkage.joints = {
      {.name = "rail", .from = kGroundName, .to = "rail", .placement = {.p = {0.01, 0.0, 0.0}}, .freedoms = {{.name = "rail", .start = 0.05}}},
      {.name = "slide", .kind = JointKind::kPrismatic, .from = "rail", .to = "carriage", .placement = {}, .axes = {Axis::kX, Axis::kY},
       .freedoms = {{.name = "x", .guess = 0.05, .stiffness = 50.0, .damping = 2.0}}},
      {.name = "crank", .from = "carriage", .to = "crank", .placement = {.p = {0.0, 0.02, 0.01}},
       .freedoms = {{.name = "crank", .drive = Harmonic{0.1, 0.3, 5.0, 0.4}}}},
      {.name = "rocker", .from = kGroundName, .to = "rocker", .placement = {.p = {0.45, 0.0, 0.0}}, .freedoms = {{.name = "rocker", .guess = 1.6}}},
      {.name = "ball", .kind = JointKind::kSpherical, .from = "crank", .to = "rod", .placement = {.p = {0.1, 0.0, -0.01}},
       .freedoms = {{.name = "z", .guess = 0.7}, {.name = "y"}, {.name = "x_turn"}}},
      {.name = "elbow", .from = "rocker", .to = "arm", .placement = {.p = {0.2, 0.0, 0.0}}, .freedoms = {{.name = "elbow", .guess = -2.5}}},
      {.name = "end", .from = "rocker", .to = "rod", .placement = {.p = {0.3, 0.0, 0.0}}, .cut = true, .to_placement = {.p = {0.4, 0.0, 0.0}},
       .clearance = clearance},
      {.name = "foot", .from = "arm", .to = kGroundName, .placement = {.p = {0.25, 0.0, 0.0}}, .cut = true, .to_placement = {.p = {0.6, 0.0, 0.0}},
       .clearance = clearance}};
  return linkage;
}

/// A nut that slides down a screw of 20 mm a turn as it turns; turned by a drive or free.
[[nodiscard]] inline Linkage make_screw() {
  Linkage linkage;
  linkage.gravity_W = {0.0, 0.0, -9.81};
  linkage.bodies = {make_body("nut", 2.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1.5e-3})};
  linkage.joints = {{.name = "screw", .kind = JointKind::kScrew, .from = kGroundName, .to = "nut", .placement = {},
                     .lead = 0.02 / (2.0 * 3.14159265358979312),
                     .freedoms = {{.name = "slide"}, {.name = "turn", .damping = 1e-3}}}};
  return linkage;
}

}  // namespace engine
