// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace engine {

/// Laws of the friction in a joint with clearance. Formulas: friction_law.h.
enum class FrictionLaw {
  kNone,
  kLuGre,         ///< Canudas de Wit et al. (1995), with a vector bristle: Eq. (11.2)
  kDahl,          ///< Dahl (1968): LuGre without Stribeck effect, damping and viscosity
  kElastoPlastic, ///< Dupont et al. (2002): LuGre whose bristle does not creep below its break-away
  kCoulomb,       ///< Coulomb, smoothed: a root of squares
  kAmbrosio,      ///< Ambrosio (2003): Coulomb above a velocity, nothing below another, linear between
};

/// @returns whether a law remembers the deflection of a bristle
[[nodiscard]] constexpr bool has_bristles(FrictionLaw law) {
  return law == FrictionLaw::kLuGre || law == FrictionLaw::kDahl || law == FrictionLaw::kElastoPlastic;
}

/// Friction of one joint. A law reads those of its own alone.
struct FrictionParameters {
  double mu_s = 0.1;              ///< static, [1]; Dahl: as mu_k
  double mu_k = 0.2;              ///< kinetic, [1]
  double sigma_0 = 100.0;         ///< bristle stiffness, [1/m]
  double sigma_1 = 5.0;           ///< bristle damping, [s/m]; Dahl: 0
  double sigma_2 = 0.0;           ///< viscous, [s/m]; Dahl: 0
  double v_s = 1e-3;              ///< Stribeck velocity, [m/s]
  FrictionLaw law = FrictionLaw::kLuGre;
  double break_away =
      0.7;  ///< elasto-plastic: part of the steady deflection up to which a bristle does not creep, [0, 1)
  double v_0 =
      1e-4;  ///< Coulomb: where 1/sqrt(2) of full friction acts; Ambrosio: no friction below it, [m/s]
  double v_1 = 1e-3;              ///< Ambrosio: full friction above it, > v_0, [m/s]
};

}  // namespace engine
