// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "engine/model/mechanism.h"
#include "engine/model/rpsup_parameters.h"
#include "validation/engine_names.h"

namespace validation {

/// The two open chains of the paper's Fig. 2 with bodies and gravity, from the parameters alone: no look at
/// the engine's builder or at its division of the coupler. No springs, drives or cut joints.
[[nodiscard]] Mechanism make_paper_chains(const RpsupParameters& parameters);

/// Gravity in the global frame, [m/s^2]
[[nodiscard]] Eigen::Vector3d calc_gravity(const RpsupParameters& parameters);

/// Place x of the bearing on the last frame of chain 1, at the coupler's end, [m]. The journal is the last
/// frame of chain 2.
[[nodiscard]] double calc_bearing_x(const RpsupParameters& parameters);

/// The flexible coupler's elastic and dissipative terms, Eqs. (8) and (9); zeros for a rigid one.
///
///     S = diag(E I, E I, G J) / dl,  D = (2 zeta / omega_1) S,  dl = l / (n_rfe - 1),  omega_1 = (pi / l)^2
///     sqrt(E I l / m)
///
/// with the section's moments I = pi d^4 / 64 and J = pi d^4 / 32.
struct ElasticTerms {
  Eigen::VectorXd s_f;      ///< Eq. (9), one a coordinate
  double energy = 0.0;      ///< E_p,f, Eq. (8.1), [J]
  double rayleigh = 0.0;    ///< R, Eq. (8.2), [W]; twice of it is lost
};
[[nodiscard]] ElasticTerms calc_elastic_terms(const RpsupParameters& parameters, const Eigen::VectorXd& q,
                                              const Eigen::VectorXd& qd);

}  // namespace validation
