// SPDX-License-Identifier: Apache-2.0
// A bore that is worn: how far a journal gets in it against closed forms, the force of its walls, whole runs.

#include "engine/clearance/worn_bore.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/clearance/continuum_law.h"
#include "engine/clearance/radial_continuum.h"
#include "engine/model/rpsup.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/runs.h"

namespace engine {
namespace {

using std::numbers::pi;
using validation::column;
using validation::metric;

constexpr double kWornClearance = 0.25e-3;

/// One list for each of two rings, from the depth at the middle of each sector.
template <typename Depth>
WearDepth make_depth(std::size_t sectors, const Depth& depth_at) {
  std::vector<double> ring;
  for (std::size_t s = 0; s < sectors; ++s) ring.push_back(depth_at(2.0 * pi * (static_cast<double>(s) + 0.5) / static_cast<double>(sectors)));
  return {ring, ring};
}

/// Deepest at 40 degrees, flat on the other side.
double grooved(double phi) { return 12e-6 * std::exp(4.0 * (std::cos(phi - 0.7) - 1.0)); }

TEST(WornBore, LetsAJournalGoAsMuchFartherAsItIsWornAllAround) {
  for (const double depth : {0.0, 1e-6, 30e-6}) {
    const WornBore bore(kWornClearance, make_depth(36, [&](double) { return depth; }));
    for (double theta = -4.0; theta < 4.0; theta += 0.1) {
      const auto reach = bore.calc_added_clearance(1, theta);
      EXPECT_NEAR(reach.value, depth, 1e-19);
      EXPECT_EQ(reach.slope, 0.0);
      EXPECT_EQ(reach.bend, 0.0);
    }
  }
}

// A bore that is worn to a circle about another centre, a off along x: |e - a| = c is how far the journal gets.
double calc_error_of_offset_circle(std::size_t sectors) {
  constexpr double a = 20e-6, c = kWornClearance + a;
  const WornBore bore(kWornClearance, make_depth(sectors, [&](double phi) { return a * std::cos(phi) + c - kWornClearance; }));
  double worst = 0.0;
  for (double theta = 0.0; theta < 2.0 * pi; theta += 0.037) {
    const double exact = a * std::cos(theta) + std::sqrt(c * c - a * a * std::sin(theta) * std::sin(theta));
    worst = std::max(worst, std::abs(bore.calc_added_clearance(0, theta).value + kWornClearance - exact));
  }
  return worst;
}

TEST(WornBore, HasTheLocusOfABoreAboutAnotherCentre) {
  // The spline takes (1 - cos h) / 3 off a cosine, h the sectors' width, which is of order 2; that of R, at 720 angles, another 0.25 nm.
  for (const std::size_t sectors : {36U, 72U, 144U, 360U}) {
    const double smoothed = 20e-6 * (1.0 - std::cos(2.0 * pi / static_cast<double>(sectors))) / 3.0;
    EXPECT_NEAR(calc_error_of_offset_circle(sectors), smoothed, 0.03 * smoothed + 3e-10) << sectors;
  }
}

// A groove that a journal cannot reach the ground of: it lies on the two edges, as far on either side as the groove is wide.
TEST(WornBore, LetsAJournalLieOnTheEdgesOfAGroove) {
  const auto lies_on = [](double degrees) { return kWornClearance / std::cos(degrees * pi / 180.0) - kWornClearance; };
  for (const double degrees : {5.0, 40.0, 75.0, 82.0}) {
    const double depth = 1.2 * lies_on(degrees + 2.0);
    const WornBore bore(kWornClearance, make_depth(360, [&](double phi) { return std::abs(phi - pi) < degrees * pi / 180.0 ? depth : 0.0; }));
    EXPECT_GT(bore.calc_depth(0, pi), 0.99 * depth);
    // The edges lie in sectors of a degree, and the spline rounds them.
    EXPECT_GT(bore.calc_added_clearance(0, pi).value, lies_on(degrees)) << degrees;
    EXPECT_LT(bore.calc_added_clearance(0, pi).value, lies_on(degrees + 2.0)) << degrees;
    EXPECT_NEAR(bore.calc_added_clearance(0, 0.0).value, 0.0, 1e-12) << degrees;
  }
}

ClearanceParameters make_joint(double r_b, double c_r) {
  ClearanceParameters joint;
  joint.r_b = r_b;
  joint.c_r = c_r;
  joint.friction = FrictionParameters{};
  return joint;
}

ContactLoad calc_worn_load(const ClearanceParameters& joint, const JournalMotion& journal) {
  const std::vector<double> bristles{3e-5, -2e-5, 1e-5, 4e-5};
  std::vector<double> rates(4);
  JointLoad<double> load;
  add_continuum(RadialContinuum(joint), to_relative_motion(journal), bristles.data(), rates.data(), load);
  return to_contact_load(load);
}

/// A journal near the bore in any direction, tilted, that moves and turns.
class AnyJournal {
 public:
  JournalMotion make(double distance) {
    JournalMotion journal;
    const double angle = pi * uniform_(random_);
    journal.p_bj = {distance * std::cos(angle), distance * std::sin(angle), 1e-5 * uniform_(random_)};
    const Eigen::Vector3d axis(uniform_(random_), uniform_(random_), 0.0);
    journal.R_bj = Eigen::AngleAxisd(2e-4 * uniform_(random_), axis.normalized()).toRotationMatrix();
    journal.v = 0.1 * Eigen::Vector3d(uniform_(random_), uniform_(random_), uniform_(random_));
    journal.w = 10.0 * Eigen::Vector3d(uniform_(random_), uniform_(random_), uniform_(random_));
    return journal;
  }

 private:
  std::mt19937_64 random_{5};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

TEST(WornBore, WornAllAroundItIsAWiderOne) {
  constexpr double kDepth = 20e-6;
  ClearanceParameters worn = make_joint(5e-3, kWornClearance);
  worn.worn = std::make_shared<const WornBore>(kWornClearance, make_depth(24, [](double) { return kDepth; }));
  const ClearanceParameters wider = make_joint(5e-3 + kDepth, kWornClearance + kDepth);  // the same journal
  AnyJournal any;
  int pressing = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const JournalMotion journal = any.make(kWornClearance + kDepth + 2e-6);
    const ContactLoad a = calc_worn_load(worn, journal), b = calc_worn_load(wider, journal);
    pressing += b.radial_normal_sum > 0.0 ? 1 : 0;  // one that parts fast is not held back
    // Differences of lengths of 0.27 mm leave 1e-13 of a penetration of micrometres, its root in the force a little more.
    EXPECT_LE((a.force - b.force).norm(), 1e-9 * b.force.norm());
    EXPECT_LE((a.moment - b.moment).norm(), 1e-9 * (b.moment.norm() + b.force.norm() * 5e-3));
    EXPECT_NEAR(a.impact_power, b.impact_power, 1e-9 * (std::abs(b.impact_power) + b.force.norm() * 0.1));
    EXPECT_NEAR(a.friction_power, b.friction_power, 1e-9 * std::abs(b.friction_power));
    EXPECT_NEAR(a.elastic_energy, b.elastic_energy, 1e-9 * b.elastic_energy);
  }
  EXPECT_GT(pressing, 80);
}

// The force's power on a moving journal is the loss of elastic energy, also along the slope of a groove.
TEST(WornBore, ForceIsTheGradientOfWhatItStores) {
  ClearanceParameters joint = make_joint(5e-3, kWornClearance);
  joint.worn = std::make_shared<const WornBore>(kWornClearance, make_depth(48, grooved));
  joint.friction.reset();
  joint.chi = 0.0;
  AnyJournal any;
  double most_slope = 0.0;
  int touching = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const JournalMotion journal = any.make(kWornClearance + 12e-6);
    const auto energy_after = [&](double t) {
      JournalMotion moved = journal;
      moved.p_bj += t * journal.v;
      const Eigen::Vector3d turn = t * journal.w;
      moved.R_bj = Eigen::AngleAxisd(turn.norm(), turn.norm() > 0.0 ? turn.normalized() : Eigen::Vector3d::UnitX()) * journal.R_bj;
      return calc_worn_load(joint, moved).elastic_energy;
    };
    const ContactLoad load = calc_worn_load(joint, journal);
    if (load.max_penetration < 1e-6) continue;
    ++touching;
    constexpr double dt = 2e-7;  // 0.03 um
    const double rate = (8.0 * (energy_after(dt) - energy_after(-dt)) - (energy_after(2.0 * dt) - energy_after(-2.0 * dt))) / (12.0 * dt);
    const double power = load.force.dot(journal.v) + load.moment.dot(journal.w);
    EXPECT_NEAR(power, -rate, 2e-5 * load.force.norm() * 0.2);
    const Eigen::Vector2d u = journal.p_bj.head<2>().normalized();
    most_slope = std::max(most_slope, std::abs(u.x() * load.force.y() - u.y() * load.force.x()) / load.force.norm());
  }
  EXPECT_GT(touching, 100);
  EXPECT_GT(most_slope, 0.03);  // else there were no slope to forget
}

RpsupParameters worn_rpsup(const WearDepth& depth) {
  RpsupParameters parameters = validation::across_rpsup();
  parameters.wear_depth = depth;
  return parameters;
}

RunResult run(const RpsupParameters& parameters, double tolerance = 1e-7) {
  return validation::run_rpsup(parameters, {.duration = 0.3, .integrator = Integrator::kRodas5, .relative_tolerance = tolerance,
                                            .absolute_tolerance = tolerance});
}

TEST(WornRun, WithoutDepthIsTheRunOfARoundBore) {
  const RunResult round = run(validation::across_rpsup());
  const RunResult worn = run(worn_rpsup(make_depth(12, [](double) { return 0.0; })));
  for (std::size_t i = 0; i < round.metrics.size(); ++i) {
    if (std::isnan(round.metrics[i])) continue;
    EXPECT_EQ(worn.metrics[i], round.metrics[i]) << metric_table()[i].key;
  }
}

TEST(WornRun, OfABoreWornAllAroundIsThatOfAWiderOne) {
  const RunResult worn = run(worn_rpsup(make_depth(12, [](double) { return 50e-6; })));
  RpsupParameters wider = validation::across_rpsup();
  wider.bearing_radius += 50e-6;
  wider.c_r += 50e-6;
  // Hertz's stiffness of the bore as it was new.
  wider.contact_stiffness_scale = make_clearance(validation::across_rpsup()).K / make_clearance(wider).K;
  const RunResult other = run(wider);
  const RunResult narrow = run(validation::across_rpsup());
  for (const char* const key : {"peak_slider_acceleration_whole_run_m_s2", "peak_contact_force_n", "sliding_work_j", "friction_work_j"}) {
    EXPECT_NEAR(metric(worn, key), metric(other, key), 2e-3 * metric(other, key)) << key;
    EXPECT_GT(std::abs(metric(narrow, key) - metric(other, key)), 0.02 * metric(other, key)) << key;
  }
}

TEST(WornRun, KeepsAccountOfItsEnergyInAGroove) {
  const RunResult worn = run(worn_rpsup(make_depth(48, [](double phi) { return 4.0 * grooved(phi + 1.0); })));
  EXPECT_LT(metric(worn, "energy_residual"), 1e-6);
  EXPECT_GT(metric(worn, "impact_count"), 10.0);
  const double work = column(worn, "ring_1_sliding_work_j").back();
  const double depth = column(worn, "ring_1_sliding_work_penetration_j_m").back() / work;  // the mean one
  EXPECT_GT(depth, 1e-8);
  EXPECT_LT(depth, 1e-6 * metric(worn, "max_penetration_um"));
}

}  // namespace
}  // namespace engine
