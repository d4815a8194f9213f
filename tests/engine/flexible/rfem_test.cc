// SPDX-License-Identifier: Apache-2.0
// Division of a rod: masses, moments, dampers. Deflections and frequencies of the divided rod: validation/flexibility.
#include "engine/flexible/rfem.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace engine {
namespace {

const RoundBeam kCoupler{.length = 0.5, .mass = 0.306, .I_x = 3.829e-6, .diameter = 0.01, .youngs_modulus = 2.1e11,
                          .shear_modulus = 0.8e11, .damping_ratio = 0.01};

class DividedBeams : public testing::TestWithParam<int> {};

// Cutting a rod in pieces changes neither its mass nor its moments.
TEST_P(DividedBeams, KeepMassAndMomentsOfTheWhole) {
  const DividedBeam divided = divide_beam(make_beam(kCoupler), GetParam());
  ASSERT_EQ(divided.elements.size(), static_cast<std::size_t>(GetParam()));
  double x = 0.0, mass = 0.0, I_x = 0.0, I_y = 0.0, moment = 0.0;
  for (const RigidElement& rfe : divided.elements) {
    mass += rfe.mass;
    moment += rfe.mass * (x + 0.5 * rfe.length);
    I_x += rfe.inertia.x();
    I_y += rfe.inertia.y() + rfe.mass * (2.0 * x * 0.5 * rfe.length + x * x);  // Steiner to the rod's end
    x += rfe.length;
  }
  EXPECT_NEAR(x, 0.5, 1e-15);
  EXPECT_NEAR(mass, 0.306, 1e-15);
  EXPECT_NEAR(moment, 0.306 * 0.25, 1e-15);
  EXPECT_NEAR(I_x, 3.829e-6, 1e-20);
  EXPECT_NEAR(I_y, 0.306 * 0.25 / 3.0 + 0.5 * 3.829e-6, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Numbers, DividedBeams, testing::Values(2, 3, 4, 10, 64));

// zeta = 0.01 at the first pinned-pinned frequency of a rod of 0.306 kg, pi / (2 l^2) sqrt(EI l / m) = 81.545 Hz: D = 2 zeta / omega_1 S.
TEST(DividedBeam, DampsTheFirstBendingMode) {
  const DividedBeam divided = divide_beam(make_beam(kCoupler), 4);
  const double omega_1 = std::pow(std::numbers::pi / 0.5, 2) * std::sqrt(2.1e11 * std::numbers::pi * 1e-8 / 64.0 * 0.5 / 0.306);
  EXPECT_NEAR(omega_1 / (2.0 * std::numbers::pi), 81.545, 1e-3);
  EXPECT_NEAR(divided.sde.damping[0] / divided.sde.stiffness[0], 0.02 / omega_1, 1e-12);
  EXPECT_NEAR(divided.sde.damping[2] / divided.sde.stiffness[2], 0.02 / omega_1, 1e-12);
}

}  // namespace
}  // namespace engine
