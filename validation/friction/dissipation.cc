// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "validation/friction/parts.h"
#include "validation/friction/published_law.h"

namespace validation {

namespace {

/// Heat power of the contact, per normal force: the friction's power less the growth of the bristle's energy
/// sigma_0 z^2 / 2.
double calc_heat(const FrictionParameters& law, const Eigen::Vector2d& v, const Eigen::Vector2d& z) {
  const BristleForce f = calc_bristle_force(law, v, z);
  return f.force_ratio.dot(v) - law.sigma_0 * z.dot(f.bristle_rate);
}

/// Its least value over all bristles along v: through three of them goes the parabola that it is.
double find_least_heat(const FrictionParameters& law, double v) {
  const double reach = law.sigma_1 * v / law.sigma_0;  // twice the expected place of the least
  const auto heat = [&](double s) { return calc_heat(law, v * kLine, s * reach * kLine); };
  const double a = heat(0.0);
  const double b = heat(0.5);
  const double c = heat(1.0);
  const double slope = c - a;
  return b - 0.125 * slope * slope / (a - 2.0 * b + c);
}

/// The speed beyond which some bristle would give energy back.
double find_limit(const FrictionParameters& law) {
  double low = 7.0 * law.v_s;  // from here on Stribeck's curve is flat
  double high = 100.0;
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (find_least_heat(law, middle) > 0.0 ? low : high) = middle;
  }
  return high;
}

/// Least heat over bristles that sliding can have made, |z| <= mu_k / sigma_0, in units of mu_k |v|; speeds
/// from 1e-6 to 100 m/s.
double find_least_reachable_heat(const FrictionParameters& law) {
  double least = 1.0;
  for (int i = 0; i <= 320; ++i) {
    const double v = 1e-6 * std::pow(10.0, 0.025 * i);
    for (int j = 0; j <= 40; ++j)
      for (int k = 0; k < 24; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / 24.0;
        const double z = law.mu_k / law.sigma_0 * j / 40.0;
        least = std::min(
            least, calc_heat(law, {v, 0.0}, {z * std::cos(angle), z * std::sin(angle)}) / (law.mu_k * v));
      }
  }
  return least;
}

/// @param parts  speed over the largest at which no bristle gives energy back
Check compare_beside_limit(double parts) {
  const double v = 0.16 * parts;
  return compare("least heat over all bristles " + std::string(parts < 1.0 ? "just below" : "just above") +
                     " 0.16 m/s, a millionth off, over sigma_1 v^2: defaults",
                 "closed form: 1 - sigma_1 |v| / (4 g)", find_least_heat({}, v) / (5.0 * v * v), 1.0 - parts,
                 1e-12, "1", "cancellation of terms near 1");
}

Check compare_reachable_heat() {
  return limit(
      "energy given back by bristles within mu_k / sigma_0, which sliding from z = 0 never leaves, at "
      "1 um/s to 100 m/s, "
      "in any direction, over mu_k |v|",
      "none: that takes a speed beyond 0.16 m/s and a bristle beyond g / sigma_0",
      std::max(0.0, -find_least_reachable_heat({})), 1e-12, "1",
      "rounding of the terms, up to sigma_1 v / mu_k = 2500");
}

}  // namespace

Findings compute_dissipation() {
  const char* closed = "closed form: sigma_1^2 |v| = 4 g (sigma_1 + sigma_2)";
  const char* why = "cancellation in the least value, of order rounding, over its slope";
  Findings findings;
  findings.checks.push_back(
      compare("largest sliding speed at which no bristle, however bent, gives energy back: defaults", closed,
              find_limit({}), 4.0 * 0.2 / 5.0, 1e-12, "m/s", why));
  const double sigma_1 = std::sqrt(1e5);
  findings.checks.push_back(compare(
      "largest sliding speed at which no bristle, however bent, gives energy back: values of the article",
      closed, find_limit(published_law()), 4.0 * (sigma_1 + 0.4) / 1e5, 1e-12, "m/s", why));
  for (const double parts : {1.0 - 1e-6, 1.0 + 1e-6}) findings.checks.push_back(compare_beside_limit(parts));
  findings.checks.push_back(compare_reachable_heat());
  return findings;
}

}  // namespace validation
