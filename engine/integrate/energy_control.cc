// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/energy_control.h"

#include <algorithm>
#include <cmath>

namespace engine {

double EnergyControl::measure(const EnergyAccount& start, const EnergyAccount& end, double t0,
                              double dt) const {
  // Where a contact law jumps, imbalance falls only in proportion to the step.
  constexpr double kShort = 1e-5;        // [s]
  constexpr double kRounding = 1e-14;    // of the energies
  // Share of the energies' tolerance: Newton's iterations end by the tolerance.
  constexpr double kNewtonError = 1e-2;
  const double power = t0 > 0.0 ? exchanged_ / t0 : 0.0;
  const double own_part = rigid_ ? relative_ * calc_exchange(start, end) : 0.0;
  const double energies =
      std::abs(end.kinetic) + std::abs(end.potential) + end.drive_work.cwiseAbs().sum();
  const double rounding = (rigid_ ? kNewtonError * relative_ : kRounding) * energies;
  return std::abs(end.calc_balance() - start.calc_balance()) /
         (std::max(dt, kShort) * (scale_ * absolute_ + relative_ * power) + own_part + rounding);
}

}  // namespace engine
