// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/cylinder_contact.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <boost/math/special_functions/lambert_w.hpp>

namespace engine {

namespace {

using std::numbers::pi;

/// Integral of x^1.5 / sqrt(1 + x) from 0.
double integrate_liu(double x) {
  if (x > 0.02) return 0.25 * std::sqrt(x * (1.0 + x)) * (2.0 * x - 3.0) + 0.75 * std::asinh(std::sqrt(x));
  // Term by term: the two above cancel but for x^2.5.
  return x * x * std::sqrt(x) *
         (2.0 / 5.0 -
          x * (1.0 / 7.0 - x * (1.0 / 12.0 - x * (5.0 / 88.0 - x * (35.0 / 832.0 - x * (21.0 / 640.0))))));
}

ElasticForce calc_liu(double stiffness, double c_r, double delta) {
  const double x = delta / c_r;
  const double force = stiffness * delta * std::sqrt(x / (1.0 + x));
  return {force, force / delta * (1.0 + 0.5 / (1.0 + x)), stiffness * c_r * c_r * integrate_liu(x)};
}

/// delta = c F ln(F_1 / F), whose inverse is a branch of Lambert's function.
ElasticForce calc_logarithmic(double c, double F_1, double delta) {
  constexpr double kBeyond = std::numeric_limits<double>::quiet_NaN();
  const double argument = delta / (c * F_1);
  if (!(argument < 1.0 / std::numbers::e)) return {kBeyond, kBeyond, kBeyond};
  const double y = boost::math::lambert_wm1(-argument);  // -ln(F_1 / F), below -1
  const double force = -delta / (c * y);
  return {force, -1.0 / (c * (1.0 + y)), 0.5 * force * delta - 0.25 * c * force * force};
}

}  // namespace

double CylinderContact::force_scale() const {
  return law == StiffnessLaw::kJohnson ? 4.0 * pi * rigidity * clearance / std::numbers::e
                                       : 8.0 * rigidity * clearance / 2.56 * std::exp(2.0 / 3.0);
}

double CylinderContact::range() const {
  const bool logarithmic = law == StiffnessLaw::kJohnson || law == StiffnessLaw::kRadzimovsky;
  return logarithmic ? force_scale() / (pi * rigidity * std::numbers::e)
                     : std::numeric_limits<double>::infinity();
}

ElasticForce CylinderContact::calc(double delta) const {
  if (law == StiffnessLaw::kLiu) return calc_liu(0.5 * pi / std::numbers::sqrt2 * rigidity, clearance, delta);
  return calc_logarithmic(1.0 / (pi * rigidity), force_scale(), delta);
}

}  // namespace engine
