#include "engine/flexible/rfem.h"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "engine/math/rod_inertia.h"

namespace engine {

namespace {

RigidElement cut_element(const UniformRod& rod, double length) {
  const double mass = rod.mass * length / rod.length;
  return {length, mass, calc_rod_inertia(mass, length, rod.I_x * length / rod.length)};
}

}  // namespace

DividedRod divide_rod(const UniformRod& rod, int n_rfe) {
  assert(n_rfe >= 2);
  const double dl = rod.length / (n_rfe - 1);
  const double d4 = std::pow(rod.diameter, 4);
  const double EI = rod.youngs_modulus * std::numbers::pi * d4 / 64.0;
  const double GJ = rod.shear_modulus * std::numbers::pi * d4 / 32.0;
  const double omega_1 = std::pow(std::numbers::pi / rod.length, 2) * std::sqrt(EI * rod.length / rod.mass);

  DividedRod divided;
  divided.elements.assign(static_cast<std::size_t>(n_rfe), cut_element(rod, dl));
  divided.elements.front() = divided.elements.back() = cut_element(rod, 0.5 * dl);
  divided.sde.stiffness = Eigen::Vector3d(EI, EI, GJ) / dl;
  divided.sde.damping = 2.0 * rod.damping_ratio / omega_1 * divided.sde.stiffness;
  return divided;
}

}  // namespace engine
