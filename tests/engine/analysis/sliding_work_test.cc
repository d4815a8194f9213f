// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/sliding_work.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/model/rpsup.h"
#include "engine/simulate_rpsup.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/runs.h"

namespace engine {
namespace {

using validation::column;
using validation::metric;

/// A journal that presses with a force in the direction of an angle and turns about its axis.
Evaluation pressing(double t, double force, double angle, double spin) {
  Evaluation at;
  at.t = t;
  at.joints.resize(1);
  JointState& joint = at.joints[0];
  joint.journal.p_bj = 0.252e-3 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);  // 2 um beyond the clearance
  joint.journal.w = {0.0, 0.0, spin};
  joint.load.radial_normal_sum = force;
  return at;
}

// W = F r_j spin t, half of it on each of the two rings, all in the direction of the contact.
TEST(SlidingWork, IsForceTimesDistanceOfASteadilySlidingJournal) {
  const RpsupParameters parameters = validation::across_rpsup();
  SlidingWork work(parameters);
  for (int k = 0; k < 10; ++k) work.take_step(pressing(0.1 * k, 50.0, 0.7, -20.0), pressing(0.1 * (k + 1), 50.0, 0.7, -20.0));
  const double expected = 50.0 * (5e-3 - 0.25e-3) * 20.0 * 1.0;
  EXPECT_NEAR(work.total(), expected, 1e-12);
  for (const std::size_t ring : {0U, 1U}) {
    EXPECT_NEAR(work.at(ring, 1.0).work, 0.5 * expected, 1e-12);
    EXPECT_NEAR(work.at(ring, 0.0).work, 0.45 * expected, 1e-12);
    EXPECT_NEAR(work.at(ring, 1.0).work_x, 0.5 * expected * std::cos(0.7), 1e-12);
    EXPECT_NEAR(work.at(ring, 1.0).work_y, 0.5 * expected * std::sin(0.7), 1e-12);
  }
}

TEST(SlidingWork, IsOfTheRingThatPresses) {
  const RpsupParameters parameters = validation::across_rpsup();
  SlidingWork work(parameters);
  Evaluation start = pressing(0.0, 50.0, 0.0, 20.0);
  // Tilted by 1 mrad about y, the ring at +10 mm is 10 um farther out, and that at -10 mm is free.
  start.joints[0].journal.R_bj = Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  Evaluation end = start;
  end.t = 1.0;
  work.take_step(start, end);
  EXPECT_EQ(work.at(0, 1.0).work, 0.0);
  EXPECT_GT(work.at(1, 1.0).work, 4.0);
}

// A line contact's force grows nearly in proportion: three times as deep a ring has not 5.2 times the share, as by Hertz's law.
TEST(SlidingWork, IsSharedByTheStiffnessLaw) {
  RpsupParameters parameters = validation::across_rpsup();
  parameters.stiffness_law = StiffnessLaw::kJohnson;
  SlidingWork work(parameters);
  Evaluation start = pressing(0.0, 50.0, 0.0, 20.0);
  start.joints[0].journal.R_bj = Eigen::AngleAxisd(1e-4, Eigen::Vector3d::UnitY()).toRotationMatrix();  // 1 um out at one end, in at the other
  Evaluation end = start;
  end.t = 1.0;
  work.take_step(start, end);
  const ClearanceParameters joint = make_clearance(parameters);
  const double forces = joint.cylinders.calc(3e-6).force / joint.cylinders.calc(1e-6).force;
  const double speeds = (joint.r_j() + 1e-6) / (joint.r_j() - 1e-6);  // about the axis, which the outer point is farther from
  EXPECT_NEAR(work.at(1, 1.0).work / work.at(0, 1.0).work / (forces * speeds), 1.0, 1e-7);
}

// With one coefficient at all speeds friction takes mu of it, once a bristle has bent by mu / sigma_0: here a micrometre.
TEST(SlidingWork, IsTheFrictionWorkOverTheCoefficient) {
  RpsupParameters parameters = validation::across_rpsup();
  parameters.mu_s = parameters.mu_k = 0.1;
  parameters.sigma_0 = 1e5;
  parameters.sigma_1 = 0.0;
  const RunResult run = simulate_rpsup(parameters, {.duration = 2.0}, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  EXPECT_NEAR(0.1 * metric(run, "sliding_work_j") / metric(run, "friction_work_j"), 1.0, 0.02);
  const double rings = column(run, "ring_1_sliding_work_j").back() + column(run, "ring_2_sliding_work_j").back();
  EXPECT_NEAR(rings, metric(run, "sliding_work_j"), 1e-12 * rings);
}

}  // namespace
}  // namespace engine
