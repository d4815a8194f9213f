// SPDX-License-Identifier: Apache-2.0
// The planar four-bar with play in three joints, against the results that Siconos publishes.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "validation/clearances/parts.h"
#include "validation/support/linkage_runs.h"

namespace validation {

namespace {

constexpr double kGroundBar = 3.0, kCrankBar = 1.0, kCouplerBar = 4.0, kRockerBar = 2.5;  // lengths, [m]
constexpr double kMass = 1.0;                                                 // of each bar, [kg]
constexpr double kGravity = 9.81;
constexpr double kBearing = 0.06, kPlay = 0.005;  // radius and clearance, [m]
constexpr double kGain = 200.0, kBandwidth = 10.0;  // K of the tracking error's rate, and lambda
constexpr double kFourBarDuration = 1.0, kFourBarRate = 1e3;  // of the runs, [s], [Hz]
const Harmonic kTarget{.amplitude = 6.0, .omega = 0.75 * std::numbers::pi};  // of the crank, [rad]
constexpr double kStartAngles[] = {1.570823772407980, 0.3532842020624460, 1.264872058968431};
constexpr const char* kSource =
    "Siconos, examples/mechanics/FourBarLinkageWith3clearance, steps of 1e-4 s";

/// Angles of coupler and rocker of the ideal four-bar, and their rates over that of the crank.
struct IdealPose {
  double coupler, rocker, coupler_ratio, rocker_ratio;
};

IdealPose find_pose(double crank) {
  const double x = kCrankBar * std::cos(crank), y = kCrankBar * std::sin(crank);
  const double far = std::hypot(kGroundBar - x, -y);
  const double along = (kCouplerBar * kCouplerBar - kRockerBar * kRockerBar + far * far) / (2.0 * far);
  IdealPose pose{};
  pose.coupler = std::atan2(-y, kGroundBar - x) + std::acos(along / kCouplerBar);
  pose.rocker = std::atan2(y + kCouplerBar * std::sin(pose.coupler),
                           x + kCouplerBar * std::cos(pose.coupler) - kGroundBar);
  const double across = std::sin(pose.coupler - pose.rocker);
  pose.coupler_ratio = kCrankBar * std::sin(pose.rocker - crank) / (kCouplerBar * across);
  pose.rocker_ratio = kCrankBar * std::sin(pose.coupler - crank) / (kRockerBar * across);
  return pose;
}

/// Moment of inertia of the ideal four-bar about its crank. @param rocker_part  of the rocker's moment
double calc_inertia(double crank, double rocker_part) {
  const IdealPose pose = find_pose(crank);
  return kMass * kCrankBar * kCrankBar * (1.0 / 3.0 + 1.0) +
         kMass * std::pow(kCouplerBar * pose.coupler_ratio, 2) / 3.0 +
         kMass * kCrankBar * kCouplerBar * pose.coupler_ratio * std::cos(crank - pose.coupler) +
         rocker_part * kMass * std::pow(kRockerBar * pose.rocker_ratio, 2) / 3.0;
}

/// Torque of the published controller beside its feedback K (ed + lambda e): inertia and weight of the ideal
/// four-bar. The term with the square of the speed has half the moment of the rocker, as published.
double calc_feedforward(double t, double crank, double speed) {
  constexpr double kStep = 1e-5;
  const DrivenMotion target = calc_driven_motion(kTarget, t);
  const double error = crank - target.q;
  const double acceleration = target.qdd - kBandwidth * (speed - target.qd);
  const double slope = (calc_inertia(crank + kStep, 0.5) - calc_inertia(crank - kStep, 0.5)) / (2.0 * kStep);
  const IdealPose pose = find_pose(crank);
  const double weight = kMass * kGravity *
                        (1.5 * kCrankBar * std::cos(crank) +
                         0.5 * kCouplerBar * pose.coupler_ratio * std::cos(pose.coupler) +
                         0.5 * kRockerBar * pose.rocker_ratio * std::cos(pose.rocker));
  return calc_inertia(crank, 1.0) * acceleration +
         0.5 * slope * speed * (speed - kBandwidth * error) + weight;
}

ClearanceParameters make_loose_joint() {
  ClearanceParameters joint;
  joint.r_b = kBearing;
  joint.c_r = kPlay;
  joint.c_a = std::numeric_limits<double>::infinity();
  joint.L_b = 0.1;
  joint.K = 1e10;
  joint.chi = 20.0;  // hardly any rebound: there is none in the published model
  joint.friction = FrictionParameters{.mu_s = 0.1, .mu_k = 0.1, .sigma_0 = 1e6, .sigma_1 = 100.0};
  return joint;
}

/// @param end  where the other end lies along x, over the length: 1 or -1
LinkageBody make_uniform_bar(const char* name, double length, double end) {
  const double about_end = kMass * length * length / 3.0;
  return {.name = name,
          .mass = kMass,
          .com = {0.5 * end * length, 0.0, 0.0},
          .inertia = Eigen::Vector3d(0.1 * about_end, about_end, about_end).asDiagonal()};
}

std::vector<LinkageFreedom> freedoms_at_rest(const std::string& joint, double turn) {
  std::vector<LinkageFreedom> freedoms;
  for (const char* const part : {"_x", "_y", "_z", "_turn_z", "_turn_y", "_turn_x"})
    freedoms.push_back({.name = joint + part, .start = 0.0, .start_rate = 0.0});
  freedoms[3].start = turn;
  return freedoms;
}

/// The crank with a controller that follows its target and a torque over time beside it.
LinkageJoint make_controlled_crank(const TableCurve& feedforward) {
  const Controller controller{.target = kTarget,
                              .controlled = Controller::Controlled::kPosition,
                              .proportional = kGain * kBandwidth,
                              .derivative = kGain};
  return {.name = "crank",
          .from = kGroundName,
          .to = "crank",
          .placement = {},
          .freedoms = {{.name = "crank",
                        .start = kStartAngles[0],
                        .start_rate = 0.0,
                        .actuator = controller,
                        .load = ForceLaw{.law = feedforward}}}};
}

LinkageJoint make_third_joint() {
  return {.name = "third",
          .from = kGroundName,
          .to = "rocker",
          .placement = {.p = {kGroundBar, 0.0, 0.0}},
          .freedoms = freedoms_at_rest("third", kStartAngles[2]),
          .clearance = make_loose_joint()};
}

LinkageJoint make_second_joint() {
  return {.name = "second",
          .from = "rocker",
          .to = "coupler",
          .placement = {.p = {kRockerBar, 0.0, 0.0}},
          .freedoms = freedoms_at_rest("second", kStartAngles[1] - kStartAngles[2]),
          .clearance = make_loose_joint()};
}

LinkageJoint make_first_joint() {
  return {.name = "first",
          .from = "coupler",
          .to = "crank",
          .placement = {.p = {-kCouplerBar, 0.0, 0.0}},
          .cut = true,
          .to_placement = {.p = {kCrankBar, 0.0, 0.0}},
          .clearance = make_loose_joint()};
}

Linkage make_four_bar(const TableCurve& feedforward) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -kGravity, 0.0};
  linkage.bodies = {make_uniform_bar("crank", kCrankBar, 1.0), make_uniform_bar("coupler", kCouplerBar, -1.0),
                    make_uniform_bar("rocker", kRockerBar, 1.0)};
  linkage.joints = {make_controlled_crank(feedforward), make_third_joint(), make_second_joint(),
                    make_first_joint()};
  return linkage;
}

/// Position and speed of the crank at samples.
struct CrankMotion {
  std::vector<double> q, v;
};

TableCurve tabulate_feedforward(const CrankMotion& crank) {
  constexpr std::size_t kEvery = 2;  // samples
  std::vector<double> times, torques;
  for (std::size_t k = 0; k < crank.q.size(); k += kEvery) {
    times.push_back(static_cast<double>(k) / kFourBarRate);
    torques.push_back(calc_feedforward(times.back(), crank.q[k], crank.v[k]));
  }
  return TableCurve(times, torques, TableInterpolation::kMonotoneCubic);
}

/// Motion of a crank whose error against the target decays by exp(-lambda t).
CrankMotion guess_crank_motion() {
  CrankMotion crank;
  for (int k = 0; k <= static_cast<int>(kFourBarDuration * kFourBarRate); ++k) {
    const double t = k / kFourBarRate, error = kStartAngles[0] * std::exp(-kBandwidth * t);
    const DrivenMotion target = calc_driven_motion(kTarget, t);
    crank.q.push_back(target.q + error);
    crank.v.push_back(target.qd - kBandwidth * error);
  }
  return crank;
}

/// Run with the feedforward along a motion of the crank.
RunResult simulate_four_bar(const CrankMotion& crank) {
  return run_linkage(make_four_bar(tabulate_feedforward(crank)),
                     RunOptions{.duration = kFourBarDuration,
                                .output_rate = kFourBarRate,
                                .integrator = Integrator::kRadau5,
                                .relative_tolerance = 1e-7,
                                .absolute_tolerance = 1e-7});
}

/// The controller's feedforward depends on the crank's motion, a table on time alone: the torque is that
/// along the motion of the run before.
/// @param change  out: of the crank's angle by the last run, [rad]
RunResult run_four_bar(double& change) {
  constexpr int kRuns = 6;  // each is ten times nearer than the one before
  CrankMotion crank = guess_crank_motion();
  RunResult run;
  for (int k = 0; k < kRuns; ++k) {
    run = simulate_four_bar(crank);
    const CrankMotion next{column(run, "crank_rad"), column(run, "crank_rad_s")};
    change = 0.0;
    for (std::size_t i = 0; i < next.q.size(); ++i)
      change = std::max(change, std::abs(next.q[i] - crank.q[i]));
    crank = next;
  }
  return run;
}

/// State of the three bars in their order, and the place of the journal in each loose joint.
struct FourBarState {
  std::array<double, 3> angles{};       ///< from the ground's x axis, [rad]
  std::array<double, 3> speeds{};       ///< [rad/s]
  std::array<double, 3> play_angles{};  ///< of the way from one part's centre to the other's, [rad]
};

FourBarState find_state(const RunResult& run, double t) {
  const auto k = static_cast<std::size_t>(std::lround(t * kFourBarRate));
  const auto value = [&](const char* key) { return column(run, key)[k]; };
  FourBarState state;
  const double rocker = value("third_turn_z_rad"), coupler = rocker + value("second_turn_z_rad");
  const double speed = value("third_turn_z_rad_s");
  state.angles = {value("crank_rad"), coupler, rocker};
  state.speeds = {value("crank_rad_s"), speed + value("second_turn_z_rad_s"), speed};
  state.play_angles = {coupler + std::atan2(-value("first_journal_y_mm"), -value("first_journal_x_mm")),
                       rocker + std::atan2(-value("second_y_m"), -value("second_x_m")),
                       std::atan2(value("third_y_m"), value("third_x_m"))};
  return state;
}

/// Rows of FourBarClearance.ref.
struct FourBarRow {
  double t;  ///< [s]
  std::array<double, 3> angles, speeds;
  std::array<double, 6> play;  ///< x and y in each loose joint, [m]
};

constexpr FourBarRow kFourBarRows[] = {
    {.t = 0.3,
     .angles = {3.979969, 0.855959, 2.003572},
     .speeds = {9.922276, 2.504780, 0.074576},
     .play = {-3.551396e-3, -3.519673e-3, -3.221319e-3, -3.824142e-3, -4.985490e-3, 0.383844e-3}},
    {.t = 0.5,
     .angles = {5.545612, 0.915803, 1.499657},
     .speeds = {5.285048, -2.184218, -4.031964},
     .play = {4.542857e-3, 2.088884e-3, -3.870198e-3, -3.136426e-3, -0.307780e-3, 4.990743e-3}},
    {.t = 0.7,
     .angles = {5.982468, 0.693936, 1.142262},
     .speeds = {-1.115200, 0.643043, 0.842336},
     .play = {3.585450e-3, 3.484984e-3, 3.290465e-3, 3.764719e-3, -1.907967e-3, -4.621717e-3}},
    {.t = 1.0,
     .angles = {4.238448, 0.918990, 1.995555},
     .speeds = {-9.985220, -2.242271, 0.828212},
     .play = {-2.382676e-3, -4.395836e-3, -1.758276e-3, -4.680762e-3, -3.791603e-3, 3.259594e-3}},
};

constexpr const char* kBarNames[] = {"crank", "coupler", "rocker"};
constexpr const char* kJointNames[] = {"crank and coupler", "coupler and rocker", "rocker and ground"};

void add_instant(Findings& findings, const FourBarState& state, const FourBarRow& row) {
  constexpr const char* kWhy = "rigid impacts there, stiff ones here; steps of first order there";
  const std::string at = " at " + std::to_string(row.t).substr(0, 3) + " s, four-bar with play";
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string bar = kBarNames[i], joint = kJointNames[i];
    findings.checks.push_back(compare("angle of the " + bar + at, kSource, state.angles[i], row.angles[i],
                                      1e-4, "rad", kWhy));
    findings.checks.push_back(compare("speed of the " + bar + at, kSource, state.speeds[i], row.speeds[i],
                                      0.01, "rad/s", kWhy));
    const double off = std::remainder(
        state.play_angles[i] - std::atan2(row.play[2 * i + 1], row.play[2 * i]), 2.0 * std::numbers::pi);
    findings.checks.push_back(limit("error of the direction of the play between " + joint + at, kSource,
                                    std::abs(off), 0.02, "rad", kWhy));
  }
}

}  // namespace

Findings compute_published_four_bar() {
  Findings findings;
  double change = 0.0;
  const RunResult run = run_four_bar(change);
  findings.checks.push_back(limit("change of the crank's angle by the last run of a controlled four-bar",
                                  "0", change, 1e-6, "rad", "a hundredth of what is compared"));
  for (const FourBarRow& row : kFourBarRows) add_instant(findings, find_state(run, row.t), row);
  return findings;
}

}  // namespace validation
