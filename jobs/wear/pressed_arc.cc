// SPDX-License-Identifier: Apache-2.0
#include "jobs/wear/pressed_arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace jobs {
namespace {

constexpr std::size_t kLeastPoints = 720;

}  // namespace

PressedArc::PressedArc(const engine::WornBore& bore, int ring, double c_r, std::size_t sectors)
    : bore_(bore), ring_(ring), c_r_(c_r), points_((kLeastPoints + sectors - 1) / sectors) {
  const std::size_t count = points_ * sectors;
  for (std::size_t k = 0; k < count; ++k) {
    const double phi = 2.0 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    cosine_.push_back(std::cos(phi));
    sine_.push_back(std::sin(phi));
    gap_.push_back(c_r + bore.calc_depth(ring, phi));
  }
  pressure_.resize(count);
}

PressedArc::Load PressedArc::calc_pressures(double distance, double theta) {
  const double x = distance * std::cos(theta);
  const double y = distance * std::sin(theta);
  Load load;
  double most = -distance;
  for (std::size_t k = 0; k < pressure_.size(); ++k) {
    const double depth = x * cosine_[k] + y * sine_[k] - gap_[k];
    if (depth > most) {
      most = depth;
      load.deepest = k;
    }
    load.pressure += pressure_[k] = std::max(depth, 0.0);
  }
  return load;
}

void PressedArc::add(double work, double theta, double penetration, std::vector<double>& by_sector) {
  const double distance = c_r_ + bore_.calc_added_clearance(ring_, theta).value + penetration;
  const Load load = calc_pressures(distance, theta);
  if (!(load.pressure > 0.0)) {  // between two of the points
    by_sector[load.deepest / points_] += work;
    return;
  }
  for (std::size_t k = 0; k < pressure_.size(); ++k)
    by_sector[k / points_] += work * (pressure_[k] / load.pressure);
}

}  // namespace jobs
