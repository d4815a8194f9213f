// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/energy_control.h"

#include <algorithm>
#include <cmath>

namespace engine {

double EnergyControl::measure(const EnergyAccount& start, const EnergyAccount& end, double t0,
                              double dt) const {
  // Where a contact law jumps, imbalance falls only in proportion to the step.
  constexpr double kShort = 1e-5;  // [s]
  const double power = t0 > 0.0 ? exchanged_ / t0 : 0.0;
  constexpr double kRounding = 1e-14, kNewtonError = 1e-9;  // of the energies
  const double own_part = rigid_ ? relative_ * calc_exchange(start, end) : 0.0;
  const double rounding =
      (rigid_ ? kNewtonError : kRounding) * (std::abs(end.kinetic) + std::abs(end.potential) + end.drive_work.cwiseAbs().sum());
  return std::abs(end.calc_balance() - start.calc_balance()) /
         (std::max(dt, kShort) * (scale_ * absolute_ + relative_ * power) + own_part + rounding);
}

}  // namespace engine
