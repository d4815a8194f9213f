// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_runge_kutta_fehlberg78.hpp>
#include <boost/numeric/odeint/stepper/generation/make_controlled.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "engine/clearance/friction.h"
#include "validation/engine_names.h"

namespace validation {

/// The values of the article that introduced the law (Canudas de Wit, Olsson, Åström, Lischinsky, IEEE Trans.
/// Automatic Control 40(3), 1995), with a normal force of 1 N: F_s = 1.5 N, F_c = 1 N, sigma_0 = 1e5 N/m,
/// sigma_1 = sqrt(1e5) N s/m, sigma_2 = 0.4 N s/m.
[[nodiscard]] inline FrictionParameters published_law() {
  return {.mu_s = 1.5, .mu_k = 1.0, .sigma_0 = 1e5, .sigma_1 = std::sqrt(1e5), .sigma_2 = 0.4, .v_s = 1e-3};
}

/// Motion on a line askew to the tangent frame, so that both components of the law's vectors take part.
inline const Eigen::Vector2d kLine{0.6, 0.8};

[[nodiscard]] inline BristleForce calc_on_line(const FrictionParameters& law, double v, double z_t,
                                               double z_axial) {
  return calc_bristle_force(law, v * kLine, {z_t, z_axial});
}

using OdeState = std::vector<double>;

/// Fehlberg's method of order 7 with an error estimate of order 8.
[[nodiscard]] inline auto make_fehlberg(double absolute_tolerance, double relative_tolerance) {
  return boost::numeric::odeint::make_controlled(absolute_tolerance, relative_tolerance,
                                                 boost::numeric::odeint::runge_kutta_fehlberg78<OdeState>());
}

/// Moves a state on from t to `until` exactly.
/// @param dt  in: the step to try; out: the next one
template <typename Stepper, typename Rates>
void advance(Stepper& stepper, const Rates& rates, OdeState& y, double& t, double until, double& dt) {
  while (t < until) {
    double step = std::min(dt, until - t);
    const bool last = step == until - t;
    const bool accepted = stepper.try_step(rates, y, t, step) == boost::numeric::odeint::success;
    if (accepted && last) t = until;
    dt = accepted && last ? std::max(dt, step) : step;
  }
}

}  // namespace validation
