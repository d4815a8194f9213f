// SPDX-License-Identifier: Apache-2.0
#include "engine/model/velocity_table.h"

#include <algorithm>
#include <cmath>

namespace engine {

DrivenMotion VelocityTable::calc(double t) const {
  const TableCurve::Point p = curve_.calc(t);
  return {start_ + p.integral, p.value, p.slope, p.second};
}

double VelocityTable::time_scale(double t) const {
  const TableCurve::Point p = curve_.calc(t);
  return 1.0 / std::max({std::abs(p.value), std::sqrt(std::abs(p.slope)), std::cbrt(std::abs(p.second)),
                         std::sqrt(std::sqrt(std::abs(p.third)))});
}

}  // namespace engine
