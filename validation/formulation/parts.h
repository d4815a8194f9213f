// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/model/mechanism.h"
#include "engine/model/rpsup_parameters.h"
#include "validation/findings.h"
#include "validation/support/random.h"

namespace validation {

/// A linkage whose equations of motion are looked at: the paper's, but with no two of its lengths alike and
/// its guide off both axes.
struct CouplerCase {
  std::string name;
  RpsupParameters parameters;
};
/// Rigid, and flexible with 2, 4 and 10 rigid elements; rigid and with 4 also with a turned guide, the yoke
/// about it and across it.
[[nodiscard]] std::vector<CouplerCase> coupler_cases();

/// Angles over the whole turn but for each joint's second one (it stays 20 degrees off a right angle, where a
/// joint of three angles is singular), slides of 0.3 m, rates of 10 rad/s and 2 m/s.
struct ChainState {
  Eigen::VectorXd q, qd;
};
[[nodiscard]] ChainState draw_state(const Mechanism& mechanism, Random& random);

/// The mechanism's open chains: no cut joints, no drives.
[[nodiscard]] Mechanism open_chains(Mechanism mechanism);

/// Largest difference relative to the largest magnitude expected. NaN where any entry is not finite.
[[nodiscard]] double relative_difference(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected);

/// M, h, g, energies, s_f and accelerations of the engine equal those of 4x4 matrices and traces.
[[nodiscard]] Findings compute_trace_form();
/// Slopes of the engine's own energies give the same terms, as Lagrange's equations demand.
[[nodiscard]] Findings compute_energy_differences();
/// Contact forces, and the multipliers of an ideal joint, enter the equations of motion by the work of their
/// points.
[[nodiscard]] Findings compute_virtual_work();

}  // namespace validation
