// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/rings_side_by_side.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
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

std::vector<std::uint64_t> bits_of(const JointLoad<double>& load, const std::vector<double>& rates) {
  std::vector<double> numbers{load.force.x,      load.force.y,        load.force.z,           load.moment.x,     load.moment.y,        load.moment.z,
                              load.impact_power, load.friction_power, load.radial_normal_sum, load.friction_sum, load.max_penetration, load.elastic_energy};
  numbers.insert(numbers.end(), rates.begin(), rates.end());
  std::vector<std::uint64_t> bits;
  for (const double x : numbers) bits.push_back(std::bit_cast<std::uint64_t>(x + 0.0));  // the sign of a zero does not count
  return bits;
}

/// @returns how many of the rings pressed, over all journals
int expect_the_same(const ClearanceParameters& joint) {
  RandomJournals journals;
  int pressing = 0;
  for (int round = 0; round < 2000; ++round) {
    RadialContinuum contact(joint);
    const RingMotion journal = journals.next(), before = journals.next();
    const auto count = static_cast<std::size_t>(contact.bristle_count());
    std::vector<double> bristles(count), rates(count), rates_together(count, 1.0);
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
    JointLoad<double> one_by_one, together;
    for (int i = 0; i < joint.n_r; ++i) add_ring(contact, journal, i, locate_on_round_bore(contact, journal, i), bristles.data(), rates.data(), one_by_one);
    add_continuum(contact, journal, bristles.data(), rates_together.data(), together);
    EXPECT_EQ(bits_of(one_by_one, rates), bits_of(together, rates_together)) << round;
    for (int i = 0; i < joint.n_r; ++i) pressing += locate_on_round_bore(contact, journal, i).delta > 0.0 ? 1 : 0;
  }
  return pressing;
}

TEST(RingsSideBySide, DoToTheBitWhatOneDoesAfterTheOther) {
  for (const int rings : {2, 3, 4, 5, 6, 7}) {
    ClearanceParameters joint;
    joint.n_r = rings;
    joint.c_r = kRingsClearance;
    for (const auto law : {FrictionLaw::kLuGre, FrictionLaw::kDahl, FrictionLaw::kElastoPlastic, FrictionLaw::kCoulomb, FrictionLaw::kAmbrosio}) {
      joint.friction = FrictionParameters{.law = law};
      const int pressing = expect_the_same(joint);
      EXPECT_GT(pressing, 100 * rings);
      EXPECT_LT(pressing, 1900 * rings);
    }
    joint.friction.reset();
    joint.damping = 300.0;
    expect_the_same(joint);
  }
}

}  // namespace
}  // namespace engine
