// SPDX-License-Identifier: Apache-2.0
// A block in a slot and a piston in a cylinder: impacts, a moment, friction along the joint.

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "validation/clearances/loose_body.h"
#include "validation/clearances/parts.h"
#include "validation/contact/sliding_mass.h"
#include "validation/support/linkage_runs.h"

namespace validation {

namespace {

constexpr double kWallSpeed = 0.1;                    // [m/s]
constexpr double kTiltingMoment = 2.0;                // [N m]
constexpr double kSlopeAngle = 0.5, kSlopeMu = 0.25;  // [rad], [1]
constexpr std::size_t kTurnAboutY = 4;                // freedom of a loose body

ClearanceParameters make_cylinder() {
  ClearanceParameters cylinder = make_socket();
  cylinder.geometry = ContactGeometry::kJournalInBore;
  cylinder.r_b = kBlockHalf + kSlotPlay;
  cylinder.c_r = kSlotPlay;
  cylinder.L_b = kBlockLength;
  cylinder.K = 1e9;
  return cylinder;
}

/// At rest under a moment about y, after dampers have done their work.
RunResult rest_tilted(JointKind kind, const ClearanceParameters& clearance) {
  Linkage linkage = make_loose_body(kind, clearance, {}, Eigen::Vector3d::Zero());
  std::vector<LinkageFreedom>& freedoms = linkage.joints[0].freedoms;
  for (std::size_t i = 0; i < freedoms.size(); ++i) freedoms[i].damping = i < 3 ? 100.0 : 0.1;
  freedoms[kTurnAboutY].load = ForceLaw{.law = Constant{kTiltingMoment}};
  return run_linkage(linkage, Integrator::kRadau5, 1.0);
}

/// The moment at which the edges of a block bear a tilt: 2 F arm, F = 2 K delta^1.5 of the two corners of an
/// edge.
double find_moment_of_block(double angle) {
  const double s = std::sin(angle), c = std::cos(angle), half = 0.5 * kBlockLength;
  const double delta = kBlockHalf * c + half * s - kBlockHalf - kSlotPlay;
  return 4.0 * make_slot().K * std::pow(delta, 1.5) * (half * c - kBlockHalf * s);
}

/// The same of the rings at both ends of a piston, each with half the stiffness.
double find_moment_of_piston(double angle) {
  const double half = 0.5 * kBlockLength, delta = half * std::sin(angle) - kSlotPlay;
  return make_cylinder().K * std::pow(delta, 1.5) * half * std::cos(angle);
}

/// One of the two pairs of walls that a block meets in its slot.
struct Walls {
  const char* axis;  ///< across them
  std::size_t freedom;
  double play;  ///< [m]
};

/// Speeds of a block at the middle of its slot, after each impact.
std::vector<double> list_crossing_speeds(const RunResult& run, const std::string& axis) {
  const std::vector<double>& x = column(run, axis + "_m");
  std::vector<double> speeds;
  for (std::size_t k = 1; k < x.size(); ++k)
    if (x[k - 1] * x[k] < 0.0) speeds.push_back(std::abs(column(run, axis + "_m_s")[k]));
  return speeds;
}

void add_impacts_on_walls(Findings& findings, const Walls& walls) {
  ClearanceParameters slot = make_slot();
  slot.chi = 0.75 * (1.0 - 0.25);
  const double e = rebound_ratio(slot.chi);
  LooseStarts starts{};
  starts[walls.freedom].rate = kWallSpeed;
  const Linkage bouncing = make_loose_body(JointKind::kPrismatic, slot, starts, Eigen::Vector3d::Zero());
  const double across = 2.0 * walls.play / kWallSpeed;  // time at the first speed, [s]
  const RunResult run = run_linkage(bouncing, Integrator::kDopri5, 6.0 * across, 1e4);
  const std::string axis = walls.axis;
  const std::vector<double> speeds = list_crossing_speeds(run, axis);
  for (const std::size_t n : {1, 2, 3})
    findings.checks.push_back(compare(
        "speed of a block after " + std::to_string(n) + " impacts on the walls across " + axis, "e^n v",
        speeds.at(n - 1), std::pow(e, static_cast<double>(n)) * kWallSpeed, 1e-8, "m/s", kStepTolerance));
}

/// A block that rests on a wall of its slot, at the start of its way down.
Linkage make_block_on_slope() {
  const double s = std::sin(kSlopeAngle), c = std::cos(kSlopeAngle);
  ClearanceParameters slot = make_slot();
  slot.friction = make_stiff_friction(kSlopeMu);
  slot.damping = 100.0;
  const double depth = std::pow(kLooseMass * kStandardGravity * c / (4.0 * slot.K), 2.0 / 3.0);
  return make_loose_body(JointKind::kPrismatic, slot, {{{-kSlotPlay - depth}, {}, {}, {}, {}, {}}},
                         {-kStandardGravity * c, 0.0, kStandardGravity * s});
}

void add_block_on_slope(Findings& findings) {
  const Linkage incline = make_block_on_slope();
  const RunResult slides = run_linkage(incline, Integrator::kRadau5, 0.5);
  const double s = std::sin(kSlopeAngle), c = std::cos(kSlopeAngle);
  findings.checks.push_back(compare("acceleration of a block down its slot with friction",
                                    "g (sin a - mu cos a)", column(slides, "z_m_s2").back(),
                                    kStandardGravity * (s - kSlopeMu * c), 1e-5, "m/s^2",
                                    "its corners have come to rest in 0.5 s"));
  findings.checks.push_back(limit("energy residual of its run", "0",
                                  metric_of(incline, slides, "energy_residual"), 1e-7, "1", kStepTolerance));
}

Check compare_falling_piston() {
  const Linkage falling =
      make_loose_body(JointKind::kCylindrical, make_cylinder(), {}, {0.0, 0.0, -kStandardGravity});
  return compare("way of a piston that falls along its cylinder in 0.5 s", "-g t^2 / 2",
                 column(run_linkage(falling, Integrator::kDopri5, 0.5), "z_m").back(),
                 -0.5 * kStandardGravity * 0.25, 1e-9, "m", kStepTolerance);
}

}  // namespace

Findings compute_block_impacts() {
  Findings findings;
  add_impacts_on_walls(findings, {"x", 0, kSlotPlay});
  add_impacts_on_walls(findings, {"y", 1, 2.0 * kSlotPlay});
  return findings;
}

Findings compute_tilted_bodies() {
  Findings findings;
  const RunResult block = rest_tilted(JointKind::kPrismatic, make_slot());
  findings.checks.push_back(compare("moment that two edges of a tilted block bear",
                                    "statics at the tilt found",
                                    find_moment_of_block(column(block, "turn_y_rad").back()), kTiltingMoment,
                                    1e-9, "N m", "at rest up to the steps' tolerance"));
  const RunResult piston = rest_tilted(JointKind::kCylindrical, make_cylinder());
  findings.checks.push_back(compare("moment that two rings of a tilted piston bear",
                                    "statics at the tilt found",
                                    find_moment_of_piston(column(piston, "turn_y_rad").back()),
                                    kTiltingMoment, 1e-9, "N m", "at rest up to the steps' tolerance"));
  return findings;
}

Findings compute_sliding_bodies() {
  Findings findings;
  add_block_on_slope(findings);
  findings.checks.push_back(compare_falling_piston());
  return findings;
}

}  // namespace validation
