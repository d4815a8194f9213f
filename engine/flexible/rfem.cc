// SPDX-License-Identifier: Apache-2.0
#include "engine/flexible/rfem.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace engine {

namespace {

RigidElement cut_element(const UniformBeam& beam, double length) {
  UniformBeam piece = beam;
  piece.length = length;
  piece.mass = beam.mass * length / beam.length;
  piece.I_x = beam.I_x * length / beam.length;
  return {length, piece.mass, calc_beam_inertia(piece)};
}

}  // namespace

Eigen::Vector3d calc_beam_inertia(const UniformBeam& beam) {
  const double across = beam.mass * beam.length * beam.length / 3.0;
  return {beam.I_x, across + beam.share_y * beam.I_x, across + (1.0 - beam.share_y) * beam.I_x};
}

UniformBeam make_beam(const RoundBeam& round) {
  const double d4 = std::pow(round.diameter, 4) - std::pow(round.inner_diameter, 4);
  const double EI = round.youngs_modulus * std::numbers::pi * d4 / 64.0;
  return {.length = round.length, .mass = round.mass, .I_x = round.I_x, .EI_y = EI, .EI_z = EI,
          .GJ = round.shear_modulus * std::numbers::pi * d4 / 32.0, .damping_ratio = round.damping_ratio};
}

DividedBeam divide_beam(const UniformBeam& beam, int n_rfe) {
  assert(n_rfe >= 2);
  const double dl = beam.length / (n_rfe - 1);
  const double omega_1 = std::pow(std::numbers::pi / beam.length, 2) *
                         std::sqrt(std::min(beam.EI_y, beam.EI_z) * beam.length / beam.mass);

  DividedBeam divided;
  divided.elements.assign(static_cast<std::size_t>(n_rfe), cut_element(beam, dl));
  divided.elements.front() = divided.elements.back() = cut_element(beam, 0.5 * dl);
  divided.sde.stiffness = Eigen::Vector3d(beam.EI_z, beam.EI_y, beam.GJ) / dl;
  divided.sde.damping = 2.0 * beam.damping_ratio / omega_1 * divided.sde.stiffness;
  return divided;
}

}  // namespace engine
