// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "engine/model/rpsup.h"

namespace bench {

/// The study's linkage with these three numbers, everything else as by default.
/// @param c_r    radial clearance, [m]; 0: the ideal joint
/// @param omega  crank velocity, [rad/s]
[[nodiscard]] engine::RpsupParameters linkage(engine::Coupler coupler, double c_r, double omega);

/// Every coordinate of a mechanism and its rate.
struct Coordinates {
  Eigen::VectorXd q, qd;
};

/// At t = 0, the loop closed and the drives at rest.
/// @throws std::runtime_error if the loop does not close
[[nodiscard]] Coordinates assemble(const engine::Mechanism& mechanism);

/// The same with the coupler turned until every ring of the journal touches the bore and slides on it; with
/// an ideal joint without the turn.
[[nodiscard]] Coordinates assemble_in_contact(const engine::RpsupParameters& parameters,
                                              const engine::Rpsup& rpsup);

}  // namespace bench
