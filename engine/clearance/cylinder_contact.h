// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace engine {

/// Laws of the elastic force between journal and bore.
enum class StiffnessLaw {
  kHertz,        ///< K delta^1.5, the paper's
  kJohnson,      ///< cylinders: delta = F / (pi E* L) (ln(4 pi E* L c_r / F) - 1). Johnson, Contact Mechanics
                 ///< (1985), section 5.6
  kRadzimovsky,  ///< cylinders: delta = F / (pi E* L) (2/3 + ln(4 D_b D_j / b^2)), b = 1.6 sqrt(F D_b D_j /
                 ///< (2 c_r L E*)) (1953; as in Roark)
  kLiu,          ///< cylinders: F = pi/2 E* L delta sqrt(delta / (2 (c_r + delta))). Liu, Zhang, Yang (2007)
};

/// An elastic force at one penetration.
struct ElasticForce {
  double force;   ///< [N]; not a number beyond the law's range: ask range() first
  double slope;   ///< by the penetration, [N/m]
  double energy;  ///< stored, [J]
};

/// Two long cylinders, the journal inside the bore.
struct CylinderContact {
  StiffnessLaw law = StiffnessLaw::kHertz;
  double rigidity = 0.0;   ///< E* L, 1 / E* = 2 (1 - nu^2) / E, [N/m]
  double clearance = 0.0;  ///< c_r, [m]

  /// Largest penetration for which the law holds: from there on Johnson's and Radzimovsky's forces would
  /// fall; infinite for the others. [m]
  [[nodiscard]] double range() const;
  /// Force of the whole length. @param delta  penetration, > 0, [m]
  [[nodiscard]] ElasticForce calc(double delta) const;

 private:
  [[nodiscard]] double force_scale() const;
};

}  // namespace engine
