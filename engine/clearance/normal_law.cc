// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/normal_law.h"

namespace engine {

double calc_damping_factor(NormalForceLaw law, double k_r) {
  const double lost = 1.0 - k_r;
  switch (law) {
    case NormalForceLaw::kLankaraniNikravesh: return 0.75 * (1.0 - k_r * k_r);
    case NormalForceLaw::kHuntCrossley: return 1.5 * lost;
    case NormalForceLaw::kHerbertMcWhannell:
      return 6.0 * lost / ((2.0 * k_r - 1.0) * (2.0 * k_r - 1.0) + 3.0);
    case NormalForceLaw::kLeeWang: return 0.75 * lost;
    case NormalForceLaw::kGonthier: return (1.0 - k_r * k_r) / k_r;
    case NormalForceLaw::kFlores: return 1.6 * lost / k_r;
    case NormalForceLaw::kHuGuo: return 1.5 * lost / k_r;
    case NormalForceLaw::kCarvalhoMartins: return 1.5 * lost * (11.0 - k_r) / (1.0 + 9.0 * k_r);
    case NormalForceLaw::kKelvinVoigt: break;
  }
  return 0.0;
}

}  // namespace engine
