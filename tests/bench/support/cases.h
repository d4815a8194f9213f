#pragma once

#include <Eigen/Core>

#include "engine/model/rpsup.h"

namespace bench {

/// The study's linkage with these three numbers, everything else as by default.
/// @param c_r    radial clearance, [m]; 0: the ideal joint
/// @param omega  crank velocity, [rad/s]
[[nodiscard]] engine::RpsupParameters linkage(engine::Coupler coupler, double c_r, double omega);

/// Coordinates of the mechanism at t = 0, its loop closed and its drives at rest.
/// @throws std::runtime_error if the loop does not close
[[nodiscard]] Eigen::VectorXd assemble(const engine::Mechanism& mechanism);

/// The same with the journal pushed against the bore, so that every ring touches.
[[nodiscard]] Eigen::VectorXd assemble_in_contact(const engine::Rpsup& rpsup);

}  // namespace bench
