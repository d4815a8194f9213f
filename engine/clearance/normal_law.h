// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace engine {

/// Laws of the damping in a contact, f_n = f_e (1 + chi rate / rate at the onset), by their chi(k_r); and
/// Kelvin and Voigt's.
enum class NormalForceLaw {
  kLankaraniNikravesh,  ///< (1990) 3/4 (1 - k_r^2), the paper's
  kHuntCrossley,        ///< (1975) 3/2 (1 - k_r)
  kHerbertMcWhannell,   ///< (1977) 6 (1 - k_r) / ((2 k_r - 1)^2 + 3)
  kLeeWang,             ///< (1983) 3/4 (1 - k_r)
  kGonthier,            ///< (2004) (1 - k_r^2) / k_r
  kFlores,              ///< (2011) 8/5 (1 - k_r) / k_r
  kHuGuo,               ///< (2015) 3/2 (1 - k_r) / k_r
  kCarvalhoMartins,     ///< (2019) 3/2 (1 - k_r) (11 - k_r) / (1 + 9 k_r)
  kKelvinVoigt,         ///< f_n = f_e + d rate, cut at 0: no restitution coefficient
};

/// @returns whether a law has a meaning at k_r = 0. The part of its speed that a body keeps there is not 0:
/// 0.06 by Carvalho and Martins, 0.49 where chi is 3/2, 0.66 where it is 3/4.
[[nodiscard]] constexpr bool has_zero_restitution(NormalForceLaw law) {
  return law != NormalForceLaw::kGonthier && law != NormalForceLaw::kFlores && law != NormalForceLaw::kHuGuo;
}

/// chi of a law; 0 for Kelvin and Voigt's.
/// @param k_r  restitution coefficient, [0, 1], above 0 unless has_zero_restitution()
[[nodiscard]] double calc_damping_factor(NormalForceLaw law, double k_r);

}  // namespace engine
