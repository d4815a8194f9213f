// SPDX-License-Identifier: Apache-2.0
#include "validation/reference/steel_links.h"

#include <numbers>

namespace validation {

using engine::kLinkCount;
using engine::LinkInertia;
using engine::beam_inertia;

namespace {

constexpr double kSteelDensity = 7800.0;  // [kg/m^3]

struct Tube {
  double mass, axial, transverse;  ///< moments about its axis and about a diameter through the centre of mass
};

Tube calc_tube(double outer_diameter, double inner_diameter, double length) {
  const double outer = 0.25 * outer_diameter * outer_diameter;
  const double inner = 0.25 * inner_diameter * inner_diameter;
  const double mass = kSteelDensity * std::numbers::pi * (outer - inner) * length;
  return {mass, 0.5 * mass * (outer + inner), mass * (3.0 * (outer + inner) + length * length) / 12.0};
}

LinkInertia calc_tube_along_x(double outer_diameter, double inner_diameter, double length) {
  const Tube tube = calc_tube(outer_diameter, inner_diameter, length);
  return beam_inertia(tube.mass, length, tube.axial);
}

LinkInertia calc_box(double x, double y, double z) {
  const double mass = kSteelDensity * x * y * z;
  return {mass, mass / 12.0 * Eigen::Vector3d(y * y + z * z, x * x + z * z, x * x + y * y)};
}

LinkInertia calc_tube_along_z(double outer_diameter, double inner_diameter, double length) {
  const Tube tube = calc_tube(outer_diameter, inner_diameter, length);
  return {tube.mass, {tube.transverse, tube.transverse, tube.axial}};
}

}  // namespace

std::array<LinkInertia, kLinkCount> steel_links() {
  return {calc_tube_along_x(0.028, 0.020, 0.2), calc_tube_along_x(0.020, 0.0, 0.2),
          calc_tube_along_x(0.010, 0.0, 0.5), calc_box(0.020, 0.100, 0.050),
          calc_tube_along_z(0.020, 0.015, 0.1)};
}

}  // namespace validation
