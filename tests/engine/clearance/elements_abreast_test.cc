// SPDX-License-Identifier: Apache-2.0
// Contact elements taken eight at a time against the same elements one by one, all of a ring, with every law of friction.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/clearance/elements_law.h"

namespace engine {
namespace {

struct Ring {
  int elements;
  double c_r;
  FrictionLaw law;
  int widenings;  ///< of the windows
};
void PrintTo(const Ring& ring, std::ostream* out) {
  *out << ring.elements << " elements, clearance " << ring.c_r << ", law " << static_cast<int>(ring.law) << ", widened " << ring.widenings;
}

std::vector<Ring> all_rings() {
  std::vector<Ring> rings;
  for (const int elements : {3, 8, 9, 11, 13, 16, 36, 180})
    for (const double c_r : {5e-6, 0.25e-3})
      for (const int widenings : {0, 1}) rings.push_back({elements, c_r, FrictionLaw::kLuGre, widenings});
  for (const FrictionLaw law : {FrictionLaw::kDahl, FrictionLaw::kElastoPlastic, FrictionLaw::kCoulomb, FrictionLaw::kAmbrosio})
    rings.push_back({180, 0.25e-3, law, 0});
  return rings;
}

/// Outcome of a journal's contact.
struct Outcome {
  JointLoad<double> load;
  std::vector<double> rates;
  bool complete = true;  ///< every element that touched had a bristle
};

Outcome add_one_by_one(const RadialElements& elements, const RelativeMotion<double, double>& journal, const std::vector<double>& bristles) {
  Outcome all{.load = {}, .rates = std::vector<double>(bristles.size(), 0.0)};
  const ClearanceParameters& joint = elements.parameters();
  for (int ring = 0; ring < joint.n_r; ++ring)
    for (int k = 0; k < joint.n_ce; ++k) {
      const Vec3<double> axial = calc_ring_position(joint, ring) * journal.R.z;
      all.complete = add_element(elements, journal, axial, ring, k, bristles.data(), all.rates.data(), all.load) && all.complete;
    }
  return all;
}

Outcome add_abreast(const RadialElements& elements, const RelativeMotion<double, double>& journal, const std::vector<double>& bristles) {
  Outcome all{.load = {}, .rates = std::vector<double>(bristles.size(), 7.0)};
  all.complete = add_elements(elements, journal, bristles.data(), all.rates.data(), all.load);
  return all;
}

class ElementsAbreast : public testing::TestWithParam<Ring> {};

TEST_P(ElementsAbreast, ActAsOneByOne) {
  ClearanceParameters joint;
  joint.form = RadialForm::kElements;
  joint.c_r = GetParam().c_r;
  joint.n_ce = GetParam().elements;
  joint.friction = FrictionParameters{.v_s = 0.3, .law = GetParam().law, .v_0 = 0.1, .v_1 = 0.5};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto random_vector = [&](double size) { return Eigen::Vector3d(size * uniform(random), size * uniform(random), size * uniform(random)); };
  int touching = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const double direction = std::numbers::pi * uniform(random);
    const double distance = joint.c_r + 4e-6 + 8e-6 * uniform(random);
    JournalMotion motion;
    motion.p_bj = {distance * std::cos(direction), distance * std::sin(direction), 1e-5 * uniform(random)};
    motion.R_bj = (Eigen::AngleAxisd(std::numbers::pi * uniform(random), Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(1e-4 * uniform(random), random_vector(1.0).normalized()))
                      .toRotationMatrix();
    motion.v = random_vector(0.2);
    motion.w = random_vector(50.0);
    RadialElements elements(joint);
    std::vector<double> bristles(static_cast<std::size_t>(elements.bristle_count()));
    (void)elements.follow(motion, 0.0, bristles.data());
    for (int i = 0; i < GetParam().widenings; ++i) {
      const Eigen::VectorXd wide = elements.widen(bristles.data());
      bristles.assign(wide.begin(), wide.end());
    }
    for (double& z : bristles) z = 1e-3 * uniform(random);  // also of elements that do not touch
    const RelativeMotion<double, double> journal = to_relative_motion(motion);
    const Outcome expected = add_one_by_one(elements, journal, bristles);
    const Outcome found = add_abreast(elements, journal, bristles);
    ASSERT_EQ(found.complete, expected.complete);
    if (!expected.complete) continue;
    touching += expected.load.max_penetration > 0.0 ? 1 : 0;
    const double force = 1e-12 * (1.0 + expected.load.radial_normal_sum);
    const auto expect_same = [&](const Vec3<double>& a, const Vec3<double>& b, double difference) {
      for (const double d : {a.x - b.x, a.y - b.y, a.z - b.z}) EXPECT_LE(std::abs(d), difference);
    };
    expect_same(found.load.force, expected.load.force, force);
    expect_same(found.load.moment, expected.load.moment, force * joint.L_b);
    EXPECT_NEAR(found.load.radial_normal_sum, expected.load.radial_normal_sum, force);
    EXPECT_NEAR(found.load.friction_sum, expected.load.friction_sum, force);
    EXPECT_NEAR(found.load.impact_power, expected.load.impact_power, force);
    EXPECT_NEAR(found.load.friction_power, expected.load.friction_power, force);
    EXPECT_NEAR(found.load.elastic_energy, expected.load.elastic_energy, force * joint.c_r);
    EXPECT_NEAR(found.load.max_penetration, expected.load.max_penetration, 1e-17);
    for (std::size_t b = 0; b < bristles.size(); ++b) EXPECT_NEAR(found.rates[b], expected.rates[b], 1e-12) << "bristle " << b;
  }
  EXPECT_GT(touching, 30);
}

INSTANTIATE_TEST_SUITE_P(Rings, ElementsAbreast, testing::ValuesIn(all_rings()));

}  // namespace
}  // namespace engine
