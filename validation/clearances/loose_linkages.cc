// SPDX-License-Identifier: Apache-2.0
// Slider-cranks with clearance: the place of the cut, and the energy account of four clearances.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "validation/clearances/loose_body.h"
#include "validation/clearances/parts.h"
#include "validation/support/linkage_runs.h"

namespace validation {

namespace {

constexpr double kCrankLength = 0.05, kRodLength = 0.15;  // [m]
constexpr double kCrankSpeed = 10.0;                      // [rad/s]

LinkageBody make_bar(const char* name, double mass, double length) {
  const double m = mass * length * length / 3.0, axial = 1e-2 * m;
  return {.name = name,
          .mass = mass,
          .com = {0.5 * length, 0.0, 0.0},
          .inertia = Eigen::Vector3d(axial, m, m).asDiagonal()};
}

Linkage start_slider_crank() {
  Linkage linkage;
  linkage.bodies = {make_bar("crank", 0.2, kCrankLength),
                    make_bar("rod", 0.3, kRodLength),
                    {.name = "slider", .mass = 0.4, .inertia = 1e-4 * Eigen::Matrix3d::Identity().eval()}};
  linkage.gravity_W = {0.0, -kStandardGravity, 0.0};
  return linkage;
}

ClearanceParameters make_pin() {
  ClearanceParameters pin;
  pin.c_r = 0.1e-3;
  pin.c_a = 0.1e-3;
  pin.K = calc_hertz_stiffness(pin.r_b, pin.c_r, 2e11, 0.3);
  pin.friction = FrictionParameters{.mu_s = 0.1, .mu_k = 0.1};
  return pin;
}

LinkageJoint make_driven_crank() {
  return {.name = "crank",
          .from = kGroundName,
          .to = "crank",
          .placement = {},
          .freedoms = {{.name = "crank", .drive = RunUp{.omega = kCrankSpeed, .run_up = 0.05}}}};
}

LinkageJoint make_slider_guide(double guess) {
  return {.name = "slide",
          .kind = JointKind::kPrismatic,
          .from = kGroundName,
          .to = "slider",
          .placement = {},
          .axes = {Axis::kX, Axis::kY},
          .freedoms = {{.name = "slide", .guess = guess}}};
}

/// Freedoms of a loose joint about z, named by the joint.
std::vector<LinkageFreedom> name_freedoms(const std::string& joint, double turn_guess) {
  std::vector<LinkageFreedom> freedoms;
  for (const char* const part : {"_x", "_y", "_z", "_turn_z", "_turn_y", "_turn_x"})
    freedoms.push_back({.name = joint + part});
  freedoms[3].guess = turn_guess;
  return freedoms;
}

/// The loop is cut at the pin: the rod hangs on the slider and points at the crank.
void hang_rod_on_slider(Linkage& linkage) {
  linkage.bodies[1].com = {-0.5 * kRodLength, 0.0, 0.0};
  linkage.joints.push_back(
      {.name = "end", .from = "slider", .to = "rod", .placement = {}, .freedoms = {{.name = "end"}}});
  linkage.joints.push_back({.name = "pin",
                            .from = "crank",
                            .to = "rod",
                            .placement = {.p = {kCrankLength, 0.0, 0.0}},
                            .cut = true,
                            .to_placement = {.p = {-kRodLength, 0.0, 0.0}},
                            .clearance = make_pin()});
}

/// The loop is cut at the slider.
void hang_rod_on_crank(Linkage& linkage) {
  linkage.joints.push_back({.name = "pin",
                            .from = "crank",
                            .to = "rod",
                            .placement = {.p = {kCrankLength, 0.0, 0.0}},
                            .freedoms = name_freedoms("pin", 0.0),
                            .clearance = make_pin()});
  linkage.joints.push_back({.name = "end",
                            .from = "slider",
                            .to = "rod",
                            .placement = {},
                            .cut = true,
                            .to_placement = {.p = {kRodLength, 0.0, 0.0}}});
}

/// The pin between crank and rod has clearance. @param at_pin  the loop is cut there, else at the slider
Linkage make_loose_pin(bool at_pin) {
  Linkage linkage = start_slider_crank();
  linkage.joints = {make_driven_crank(), make_slider_guide(kCrankLength + kRodLength)};
  if (at_pin)
    hang_rod_on_slider(linkage);
  else
    hang_rod_on_crank(linkage);
  return linkage;
}

ClearanceParameters make_ball_clearance() {
  ClearanceParameters ball = make_pin();
  ball.geometry = ContactGeometry::kBallInSocket;
  ball.c_a = std::numeric_limits<double>::infinity();
  return ball;
}

ClearanceParameters make_slot_clearance() {
  ClearanceParameters slot = make_ball_clearance();
  slot.geometry = ContactGeometry::kBlockInSlot;
  slot.block_x = slot.block_y = kBlockHalf;
  slot.L_b = kBlockLength;
  slot.c_y = slot.c_r;
  slot.K = calc_sphere_stiffness(1e-3, 2e11, 0.3);
  return slot;
}

LinkageJoint make_loose_crank() {
  LinkageJoint crank = make_driven_crank();
  const DriveLaw drive = *crank.freedoms[0].drive;
  crank.freedoms = name_freedoms("crank", 0.0);
  crank.freedoms[3].drive = drive;
  crank.clearance = make_pin();
  return crank;
}

LinkageJoint make_loose_guide() {
  LinkageJoint slide = make_slider_guide(0.0);
  slide.freedoms = name_freedoms("slide", 0.0);
  slide.freedoms[0].guess = kCrankLength + kRodLength;
  slide.freedoms[3].guess = 0.0;
  slide.clearance = make_slot_clearance();
  return slide;
}

LinkageJoint make_loose_ball() {
  return {.name = "ball",
          .kind = JointKind::kSpherical,
          .from = "crank",
          .to = "rod",
          .placement = {.p = {kCrankLength, 0.0, 0.0}},
          .freedoms = name_freedoms("ball", 0.0),
          .clearance = make_ball_clearance()};
}

/// Clearance everywhere: the crank's bearing, a ball at its end, a pin in the slider, the slider in its slot.
Linkage make_all_loose() {
  Linkage linkage = start_slider_crank();
  linkage.joints = {make_loose_crank(), make_loose_guide(), make_loose_ball()};
  linkage.joints.push_back({.name = "pin",
                            .from = "slider",
                            .to = "rod",
                            .placement = {},
                            .cut = true,
                            .to_placement = {.p = {kRodLength, 0.0, 0.0}},
                            .clearance = make_pin()});
  return linkage;
}

/// Largest difference of two columns over the largest magnitude of the first.
double find_largest_deviation(const std::vector<double>& a, const std::vector<double>& b) {
  double off = 0.0, most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    off = std::max(off, std::abs(a[k] - b[k]));
    most = std::max(most, std::abs(a[k]));
  }
  return off / most;
}

}  // namespace

Findings compute_cut_elsewhere() {
  Findings findings;
  constexpr double kDuration = 0.1;  // impacts make later differences grow
  const RunResult here = run_linkage(make_loose_pin(true), Integrator::kRadau5, kDuration, 1000.0);
  const RunResult there = run_linkage(make_loose_pin(false), Integrator::kRadau5, kDuration, 1000.0);
  for (const char* const key : {"slide_m", "slide_m_s", "pin_journal_x_mm", "pin_journal_y_mm"})
    findings.checks.push_back(limit(std::string(key) + " of a slider-crank with clearance in its pin, 0.1 s",
                                    "the same with its loop cut at another joint",
                                    find_largest_deviation(column(here, key), column(there, key)), 1e-6, "1",
                                    "both runs step on their own, and each impact makes errors grow"));
  return findings;
}

Findings compute_four_clearances() {
  Findings findings;
  const Linkage loose = make_all_loose();
  const RunResult run = run_linkage(loose, RunOptions{.duration = 1.0, .output_rate = 100.0});
  findings.checks.push_back(limit("energy residual with clearance in four joints, default tolerances", "0",
                                  metric_of(loose, run, "energy_residual"), 1e-6, "1",
                                  "asked of every run at default tolerances"));
  for (const char* const joint : {"crank", "ball", "pin", "slide"}) {
    const double time = metric_of(loose, run, std::string(joint) + "_contact_time_ratio");
    findings.checks.push_back(limit(std::string("part of the run in which ") + joint + " does not touch",
                                    "less than all of it", 1.0 - time, 0.99, "1", "each joint bears loads"));
  }
  return findings;
}

}  // namespace validation
