// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/unstable_modes.h"

#include <algorithm>
#include <complex>

#include "engine/dynamics/state_layout.h"

namespace engine {

namespace {

constexpr double kShift =
    5e4;  // s, [1/s]; journals of the paper's size bounce at 1e4 to 3e4 rad/s on their bores

}  // namespace

// Matrices have their final sizes from the beginning: see MotionSystem::allocate().
UnstableModes::UnstableModes(Eigen::Index free_count)
    : response_(2 * free_count, 2 * free_count), solver_(2 * free_count) {}

Instability UnstableModes::find(MotionSystem& system, double slowest_growth) {
  Instability found;
  if (!system.factor(kShift)) return found;
  calc_response(system);
  if (!response_.allFinite() || solver_.compute(response_, false).info() != Eigen::Success) return found;
  for (const std::complex<double>& inverse : solver_.eigenvalues()) {
    const std::complex<double> eigenvalue = kShift - 1.0 / inverse;
    if (!(eigenvalue.real() > slowest_growth && eigenvalue.imag() > eigenvalue.real())) continue;
    found.growth = std::max(found.growth, eigenvalue.real());
    found.frequency = std::max(found.frequency, eigenvalue.imag());
  }
  return found;
}

void UnstableModes::calc_response(MotionSystem& system) {
  const StateLayout& layout = system.layout();
  Eigen::VectorXd column(system.time_derivative().size());
  for (int k = 0; k < response_.cols(); ++k) {  // (q, v)
    column.setZero();
    column[k] = k < layout.v() ? 1.0 / kShift : 1.0;
    system.solve_in_place(column);
    response_.col(k) << kShift * column.head(layout.free), column.segment(layout.v(), layout.free);
  }
}

}  // namespace engine
