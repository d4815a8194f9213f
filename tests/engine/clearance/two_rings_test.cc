// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/two_rings.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "engine/clearance/continuum_law.h"

namespace engine {
namespace {

using RingMotion = RelativeMotion<double, double>;

constexpr double kRingsClearance = 0.25e-3;

/// Of a journal that is a little tilted, with rings in contact or not.
class RandomJournals {
 public:
  RingMotion next() {
    const double tilt_x = 5e-3 * uniform_(random_), tilt_y = 5e-3 * uniform_(random_), far = 1.3 * kRingsClearance * std::abs(uniform_(random_));
    const double direction = 3.2 * uniform_(random_);
    RingMotion motion;
    motion.R = {{1.0, 0.0, -tilt_y}, {0.0, 1.0, tilt_x}, {tilt_y, -tilt_x, 1.0}};
    motion.p = {far * std::cos(direction), far * std::sin(direction), 1e-5};
    motion.v = {0.1 * uniform_(random_), 0.1 * uniform_(random_), 0.01 * uniform_(random_)};
    motion.w = {uniform_(random_), uniform_(random_), 10.0 * uniform_(random_)};
    return motion;
  }
  double bristle() { return 1e-4 * uniform_(random_); }

 private:
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

std::vector<std::uint64_t> bits_of(const JointLoad<double>& load, const std::array<double, 4>& rates) {
  std::vector<std::uint64_t> bits;
  for (const double x : {load.force.x, load.force.y, load.force.z, load.moment.x, load.moment.y, load.moment.z, load.impact_power, load.friction_power,
                         load.radial_normal_sum, load.friction_sum, load.max_penetration, load.elastic_energy, rates[0], rates[1], rates[2], rates[3]})
    bits.push_back(std::bit_cast<std::uint64_t>(x + 0.0));  // the sign of a zero does not count
  return bits;
}

/// @returns how many of the rings pressed, over all journals
int expect_the_same(const ClearanceParameters& joint) {
  RandomJournals journals;
  int pressing = 0;
  for (int round = 0; round < 2000; ++round) {
    RadialContinuum contact(joint);
    const RingMotion journal = journals.next(), before = journals.next();
    std::array<double, 4> bristles{}, rates{}, rates_by_two{1.0, 1.0, 1.0, 1.0};
    const auto to_journal = [](const RingMotion& m) {
      JournalMotion to;
      to.R_bj << m.R.x.x, m.R.y.x, m.R.z.x, m.R.x.y, m.R.y.y, m.R.z.y, m.R.x.z, m.R.y.z, m.R.z.z;
      to.p_bj = {m.p.x, m.p.y, m.p.z};
      to.v = {m.v.x, m.v.y, m.v.z};
      to.w = {m.w.x, m.w.y, m.w.z};
      return to;
    };
    if (round % 2 == 0) (void)contact.advance(to_journal(before), to_journal(journals.next()), 1e-5, bristles.data());  // latches some
    for (double& z : bristles) z = journals.bristle();
    JointLoad<double> one_by_one, two;
    for (const int i : {0, 1}) add_ring(contact, journal, i, locate_on_round_bore(contact, journal, i), bristles.data(), rates.data(), one_by_one);
    add_two_rings(contact, journal, 0, bristles.data(), rates_by_two.data(), two);
    EXPECT_EQ(bits_of(one_by_one, rates), bits_of(two, rates_by_two)) << round;
    for (const int i : {0, 1}) pressing += locate_on_round_bore(contact, journal, i).delta > 0.0 ? 1 : 0;
  }
  return pressing;
}

TEST(TwoRings, DoToTheBitWhatOneDoesAfterTheOther) {
  for (const auto law : {FrictionLaw::kLuGre, FrictionLaw::kDahl, FrictionLaw::kElastoPlastic, FrictionLaw::kCoulomb, FrictionLaw::kAmbrosio}) {
    ClearanceParameters joint;
    joint.c_r = kRingsClearance;
    joint.friction = FrictionParameters{.law = law};
    const int pressing = expect_the_same(joint);
    EXPECT_GT(pressing, 200);
    EXPECT_LT(pressing, 3800);
  }
  ClearanceParameters smooth;
  smooth.c_r = kRingsClearance;
  smooth.damping = 300.0;
  expect_the_same(smooth);
}

}  // namespace
}  // namespace engine
