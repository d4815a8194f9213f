// SPDX-License-Identifier: Apache-2.0
// A clamped coupler under a load at its tip.

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "engine/dynamics/inverse_dynamics.h"
#include "engine/dynamics/motion_system.h"
#include "validation/flexibility/parts.h"
#include "validation/flexibility/rods.h"
#include "validation/support/text.h"

namespace validation {

namespace {

const Rod kTipStudyRod{.mass = 0.306, .I_x = 3.829e-6};

/// Motion of the tip from where it is without load.
struct TipMotion {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< [m]
  double twist = 0.0;                           ///< about x, [rad]
};

/// Static equilibrium under a force and a moment at the tip: Newton's method on forces(q) + K q = 0 with the
/// springs as slope, which is exact for small loads.
TipMotion find_equilibrium(int segments, const Wrench& at_tip) {
  const Mechanism mechanism = cut_coupler(kTipStudyRod, segments, NearEnd::kClamped);
  const auto n = static_cast<Eigen::Index>(mechanism.coordinates.size());
  const auto last = static_cast<FrameIndex>(n) - 1;
  const Eigen::VectorXd K = stiffness_matrix(mechanism).diagonal();
  InverseDynamics inverse_dynamics(mechanism);
  Evaluation at = MotionSystem(mechanism).make_evaluation();
  const double reach = 0.5 * Rod::kLength / segments;  // of the last element
  for (int iteration = 0; iteration < 6; ++iteration) {
    calc_frame_motions(mechanism, at.q, at.qd, at.qdd, at.frames);
    const Eigen::Vector3d arm = reach * at.frames.back().R.col(0);
    inverse_dynamics.add_load(last, {at_tip.force, at_tip.moment + arm.cross(at_tip.force)});
    at.q = -inverse_dynamics.calc(at.frames).cwiseQuotient(K);
  }
  const FrameMotion& end = at.frames.back();
  return {end.p + reach * end.R.col(0) - Eigen::Vector3d(Rod::kLength, 0.0, 0.0),
          std::atan2(end.R(2, 1), end.R(1, 1))};
}

}  // namespace

Findings compute_tip_deflections() {
  constexpr double kForce = 0.01;   // [N]; the tip moves by 4e-6 m, 1e-10 of it from the change of geometry
  constexpr double kMoment = 1e-4;  // [N m]
  Findings findings;
  Table table{.caption = "Deflection of the clamped coupler's tip under a force at it, over P l^3 / (3 E I).",
              .head = {"segments", "from Jacobian and springs", "from static equilibrium, along y",
                       "from static equilibrium, along z", "1 - 1 / (4 n^2)"},
              .rows = {}};
  const double rod_deflection = kForce * std::pow(Rod::kLength, 3) / (3.0 * Rod::EI());
  const std::string reference = "(1 - 1 / (4 n^2)) P l^3 / (3 E I)";
  for (const int n : {1, 3, 9}) {
    const Mechanism mechanism = cut_coupler(kTipStudyRod, n, NearEnd::kClamped);
    const Eigen::MatrixXd J = calc_tip_jacobian(mechanism);
    const double linear =
        kForce *
        (J.row(1).array().square().transpose() / stiffness_matrix(mechanism).diagonal().array()).sum();
    const double along_y = find_equilibrium(n, {{0.0, kForce, 0.0}, Eigen::Vector3d::Zero()}).p.y();
    const double along_z = find_equilibrium(n, {{0.0, 0.0, kForce}, Eigen::Vector3d::Zero()}).p.z();
    const double twist = find_equilibrium(n, {Eigen::Vector3d::Zero(), {kMoment, 0.0, 0.0}}).twist;
    const double expected = (1.0 - 1.0 / (4.0 * n * n)) * rod_deflection;
    const std::string at = ", " + std::to_string(n) + (n == 1 ? " segment" : " segments");
    const auto add = [&](const std::string& what, double found, double relative, const std::string& why) {
      findings.checks.push_back(
          compare(what + at, reference, 1e6 * found, 1e6 * expected, relative * 1e6 * expected, "um", why));
    };
    add("tip deflection of the clamped coupler under 0.01 N, from Jacobian and springs", linear, 1e-13,
        "rounding");
    add("tip deflection of the clamped coupler in static equilibrium under 0.01 N along y", along_y, 1e-9,
        "second order in the slope, 1e-5 squared");
    add("tip deflection of the clamped coupler in static equilibrium under 0.01 N along z", along_z, 1e-9,
        "second order in the slope, 1e-5 squared");
    const double expected_twist = kMoment * Rod::kLength / Rod::GJ();
    findings.checks.push_back(compare("twist of the clamped coupler under 1e-4 N m at its tip" + at,
                                      "T l / (G J)", 1e6 * twist, 1e6 * expected_twist,
                                      1e-12 * 1e6 * expected_twist, "urad", "rounding"));
    table.rows.push_back({std::to_string(n), number(linear / rod_deflection, 9),
                          number(along_y / rod_deflection, 9), number(along_z / rod_deflection, 9),
                          number(1.0 - 1.0 / (4.0 * n * n), 9)});
  }
  findings.tables.push_back(std::move(table));
  return findings;
}

}  // namespace validation
