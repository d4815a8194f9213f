// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "validation/kinematics/parts.h"
#include "validation/reference/ideal_linkage.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/largest.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

struct Run {
  std::string name;
  RpsupParameters parameters;
  RunOptions options;
  double bound;         ///< on relative differences
  const char* why;
};

std::vector<Run> make_runs() {
  const char* solved =
      "positions solved to 1e-13 m, and a linear system of 5 forces; relative to the largest over the run";
  const char* integrated =
      "steps of 0.1 ms leave violations below 1e-12 m, and stabilisation answers them with accelerations of "
      "beta^2 times as much; relative to the "
      "largest over the run";
  std::vector<Run> runs;
  RpsupParameters p;
  p.c_r = 0.0;
  runs.push_back({"10 rad/s", p, {}, 1e-11, solved});
  RpsupParameters across = across_rpsup();
  across.c_r = 0.0;
  runs.push_back({"10 rad/s, second geometry", across, {}, 1e-11, solved});
  for (RpsupParameters* geometry : {&p, &across}) {
    geometry->crank_velocity = 12.0;
    geometry->guide_offset_y = 0.05;
    geometry->guide_offset_z = -0.15;
  }
  const std::string place = "guide at y = 0.05 m, z = -0.15 m";
  const std::string guide = "12 rad/s, " + place, guide_across = "12 rad/s, second geometry, " + place;
  runs.push_back({guide, p, {}, 1e-11, solved});
  runs.push_back({guide_across, across, {}, 1e-11, solved});
  RpsupParameters turned = p;
  turned.guide_angle = -0.2;
  turned.rod_law = StrokeLaw::kParabolic;
  turned.gravity_direction = Direction::kMinusY;
  runs.push_back({guide + ", turned by -0.2 rad, rod by the parabolic law, gravity along -y",
                  turned,
                  {},
                  1e-11,
                  solved});

  const RunOptions rk4{.duration = 1.5, .integrator = Integrator::kRk4, .step = 1e-4};
  p.rod_law = StrokeLaw::kCycloidal;  // rk4 does not end its steps where an acceleration jumps
  for (const auto& [name, geometry] :
       {std::pair{guide + ", rod by the cycloidal law", &p}, {guide_across, &across}}) {
    geometry->run_up = 0.5;
    runs.push_back({name + ", run-up in 0.5 s, joint by multipliers, rk4", *geometry, rk4, 1e-8, integrated});
    geometry->drive = DriveEnforcement::kBaumgarte;
    runs.push_back(
        {name + ", run-up in 0.5 s, joint and drives by multipliers, rk4", *geometry, rk4, 1e-8, integrated});
  }
  return runs;
}

/// A channel and what it should be.
struct ComparedReactions {
  const char* key;
  const char* name;
  const char* unit;
  std::function<double(const IdealForces&)> expected;
};

std::vector<ComparedReactions> compared_channels() {
  return {{"reaction_x_n", "joint's force on the cross link along x", "N",
           [](const IdealForces& f) { return f.reaction_W.x(); }},
          {"reaction_y_n", "joint's force on the cross link along y", "N",
           [](const IdealForces& f) { return f.reaction_W.y(); }},
          {"reaction_z_n", "joint's force on the cross link along z", "N",
           [](const IdealForces& f) { return f.reaction_W.z(); }},
          {"crank_torque_n_m", "torque of the crank's drive", "N m",
           [](const IdealForces& f) { return f.crank_torque; }},
          {"rod_force_n", "force of the rod's drive", "N", [](const IdealForces& f) { return f.rod_force; }},
          {"kinetic_energy_j", "kinetic energy", "J", [](const IdealForces& f) { return f.kinetic_energy; }},
          {"potential_energy_j", "potential energy", "J",
           [](const IdealForces& f) { return f.potential_energy; }}};
}

struct Difference {
  Largest largest, worst;
  void take(double found, double expected) {
    worst.take(found - expected);
    largest.take(expected);
  }
  [[nodiscard]] double relative() const { return worst.value() / largest.value(); }
};

/// Origins and axes of all links.
double compare_poses(const RunResult& run, const RpsupParameters& p) {
  const char* names[] = {"1_1", "1_2", "1_3", "2_1", "2_2"};
  Largest difference;
  const std::vector<double>& t = column(run, "t_s");
  for (std::size_t link = 0; link < kLinkCount; ++link) {
    const auto of = [&](const char* part) -> const std::vector<double>& {
      return column(run, std::string("pose_") + names[link] + "_" + part);
    };
    const auto &x = of("x_m"), &y = of("y_m"), &z = of("z_m"), &qw = of("qw"), &qx = of("qx"), &qy = of("qy"),
               &qz = of("qz");
    for (std::size_t k = 0; k < t.size(); ++k) {
      const Eigen::Matrix4d T = calc_ideal_motion(p, t[k], Side::kBefore)[link].T;
      Eigen::Matrix4d found = Eigen::Matrix4d::Identity();
      found.topLeftCorner<3, 3>() = Eigen::Quaterniond(qw[k], qx[k], qy[k], qz[k]).toRotationMatrix();
      found.topRightCorner<3, 1>() = Eigen::Vector3d(x[k], y[k], z[k]);
      const Eigen::Matrix4d off = found - T;
      for (const double entry : off.reshaped()) difference.take(entry);
    }
  }
  return difference.value();
}

/// The drives' power against the rate at which the links' energy grows.
Difference compare_power(const RunResult& run, const RpsupParameters& p) {
  const std::vector<double>& t = column(run, "t_s");
  const std::vector<double>& torque = column(run, "crank_torque_n_m");
  const std::vector<double>& omega = column(run, "crank_velocity_rad_s");
  const std::vector<double>& force = column(run, "rod_force_n");
  Difference difference;
  for (std::size_t k = 0; k < t.size(); ++k)
    difference.take(
        torque[k] * omega[k] + force[k] * calc_rod_displacement(p, t[k], Side::kBefore).derivative(1),
        calc_ideal_forces(p, t[k], Side::kBefore).power);
  return difference;
}

void add_reactions_of_run(const Run& r, Findings& findings, Table& differences, Table& magnitudes) {
  const RunResult run = run_rpsup(r.parameters, r.options);
  const std::vector<double>& t = column(run, "t_s");
  std::vector<IdealForces> expected;  // at a jump from before it, as the samples are
  for (const double at : t) expected.push_back(calc_ideal_forces(r.parameters, at, Side::kBefore));
  const std::string at = ", ideal rigid linkage, " + r.name;
  std::vector<std::string> row{r.name}, sizes{r.name};
  const auto add = [&](const std::string& what, const std::string& reference, const Difference& difference,
                       double bound = 0.0, const char* why = "") {
    findings.checks.push_back(limit(what + at, reference, difference.relative(), std::max(r.bound, bound),
                                    "1", r.bound < bound ? why : r.why));
    row.push_back(number(difference.relative(), 2));
    sizes.push_back(number(difference.largest.value(), 6));
  };
  for (const ComparedReactions& channel : compared_channels()) {
    const std::vector<double>& found = column(run, channel.key);
    Difference difference;
    for (std::size_t k = 0; k < t.size(); ++k) difference.take(found[k], channel.expected(expected[k]));
    add(channel.name,
        "Newton's and Euler's laws for each link of the closed form, derivatives by Taylor arithmetic",
        difference);
  }
  const std::vector<double>& work = column(run, "drive_work_j");
  Difference done;
  for (std::size_t k = 0; k < t.size(); ++k) {
    const auto energy = [&](const IdealForces& f) { return f.kinetic_energy + f.potential_energy; };
    done.take(work[k], energy(expected[k]) - energy(expected[0]));
  }
  add("work of the drives since t = 0", "kinetic and potential energy in the closed form, less the first",
      done, 1e-10, "Simpson's rule over pairs of steps of 0.25 ms; relative to the largest over the run");
  add("power of the drives, torque x rate + force x rate",
      "rate of the links' kinetic and potential energy in the closed form", compare_power(run, r.parameters));
  findings.checks.push_back(
      limit("poses of all five links" + at,
            "closed form: coupler from S joint to guide, its z axis normal to the yoke's",
            compare_poses(run, r.parameters), 1e-11, "m or 1",
            "positions solved or kept to 1e-12 m, of links of 0.2 m and more"));
  differences.rows.push_back(std::move(row));
  magnitudes.rows.push_back(std::move(sizes));
}

/// At rest the crank holds the weight of the chain at its arms where gravity acts across it: the links (1,1)
/// and (1,2) at their middles, the coupler's half at the S joint. Along the crank's axis the same half of the
/// coupler's weight is all that the joint bears.
void add_statics(Findings& findings, const std::string& name, RpsupParameters p) {
  p.c_r = 0.0;
  p.crank_velocity = p.rod_stroke = 0.0;
  const RunResult run = run_rpsup(p, {.duration = 0.01});
  const double half_coupler = 0.5 * 9.81 * 0.306;
  const bool across_the_crank = p.gravity_direction == Direction::kMinusY;
  const double middle_of_rod = p.rod_start - 0.1;
  const double torque =
      across_the_crank ? 9.81 * (0.1 * 0.471 + middle_of_rod * 0.490) + p.rod_start * half_coupler : 0.0;
  const auto add = [&](const char* key, const char* what, double expected, const char* unit) {
    findings.checks.push_back(compare(std::string(what) + ", linkage at rest" + name,
                                      "statics with the masses of Table 1", column(run, key).front(),
                                      expected, 1e-12, unit, "rounding"));
  };
  add("crank_torque_n_m", "torque of the crank's drive", torque, "N m");
  add("rod_force_n", "force of the rod's drive", 0.0, "N");
  add("reaction_x_n", "joint's force on the cross link along x", 0.0, "N");
  add("reaction_y_n", "joint's force on the cross link along y", across_the_crank ? -half_coupler : 0.0, "N");
  add("reaction_z_n", "joint's force on the cross link along z", across_the_crank ? 0.0 : -half_coupler, "N");
}

}  // namespace

Findings compute_reactions() {
  Findings findings;
  Table differences{.caption =
                        "Forces and energies of the ideal rigid linkage: largest difference relative to the "
                        "largest value of the run.",
                    .head = {"case"},
                    .rows = {},
                    .reproducible_to = 10.0};
  Table magnitudes{.caption =
                       "Forces and energies of the ideal rigid linkage: largest magnitude over the run, in "
                       "the closed form.",
                   .head = {"case"},
                   .rows = {}};
  const auto add_column = [&](const std::string& name, const std::string& unit) {
    differences.head.push_back(name);
    magnitudes.head.push_back(name + " [" + unit + "]");
  };
  for (const ComparedReactions& channel : compared_channels()) add_column(channel.name, channel.unit);
  add_column("work of the drives", "J");
  add_column("power of the drives", "W");
  RpsupParameters level;
  level.gravity_direction = Direction::kMinusY;
  add_statics(findings, ", gravity along the crank's axis", {});
  add_statics(findings, ", gravity along -y", level);
  add_statics(findings, ", second geometry, gravity along -y", across_rpsup());
  for (const Run& run : make_runs()) add_reactions_of_run(run, findings, differences, magnitudes);
  findings.tables = {std::move(differences), std::move(magnitudes)};
  return findings;
}

}  // namespace validation
