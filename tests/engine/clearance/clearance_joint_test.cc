// SPDX-License-Identifier: Apache-2.0
// Contact of a whole journal: the pruned ring of elements against all of its elements, bristles that follow it. Statics of a tilted
// journal, its faces, and the ring's limit: validation/contact.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/clearance/clearance_joint.h"
#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/continuum_law.h"
#include "engine/clearance/elements_law.h"
#include "engine/clearance/radial_continuum.h"
#include "engine/clearance/radial_elements.h"
#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"
#include "validation/support/across_rpsup.h"

namespace engine {
namespace {

ClearanceParameters joint_without_friction() {
  ClearanceParameters joint;
  joint.K = 4.78e10;
  return joint;
}

JournalMotion journal_at(double x, double y, double z = 0.0) {
  JournalMotion journal;
  journal.p_bj = {x, y, z};
  return journal;
}

ContactLoad calc_load(const RadialContinuum& radial, const JournalMotion& journal, const double* bristles, double* rates) {
  JointLoad<double> load;
  add_continuum(radial, to_relative_motion(journal), bristles, rates, load);
  return to_contact_load(load);
}

/// @returns whether every element that touched had a bristle
bool calc_load(const RadialElements& radial, const JournalMotion& journal, const double* bristles, double* rates, ContactLoad& load) {
  JointLoad<double> sum;
  const bool complete = add_elements(radial, to_relative_motion(journal), bristles, rates, sum);
  load = to_contact_load(sum);
  return complete;
}

TEST(RadialContinuum, PressesWithHertzsForceAgainstTheOffset) {
  const ClearanceParameters joint = joint_without_friction();
  const RadialContinuum radial(joint);
  std::vector<double> rates(4);
  const double delta = 3e-6;
  const ContactLoad load =
      calc_load(radial, journal_at(0.6 * (joint.c_r + delta), 0.8 * (joint.c_r + delta)), std::vector<double>(4).data(), rates.data());
  const double force = 4.78e10 * std::pow(delta, 1.5);
  EXPECT_NEAR(load.radial_normal_sum, force, 1e-9 * force);
  EXPECT_NEAR(load.force.x(), -0.6 * force, 1e-9 * force);
  EXPECT_NEAR(load.force.y(), -0.8 * force, 1e-9 * force);
  EXPECT_NEAR(load.moment.norm(), 0.0, 1e-12 * force);  // two rings at +-10 mm cancel
  EXPECT_NEAR(load.elastic_energy, 0.4 * force * delta, 1e-9 * force * delta);
  EXPECT_NEAR(load.max_penetration, delta, 1e-15);
}

TEST(RadialContinuum, NothingTouchesInsideTheClearance) {
  const ClearanceParameters joint = joint_without_friction();
  std::vector<double> rates(4, 7.0);
  const ContactLoad load = calc_load(RadialContinuum(joint), journal_at(0.9 * joint.c_r, 0.0), std::vector<double>(4).data(), rates.data());
  EXPECT_EQ(load.force.norm(), 0.0);
  EXPECT_EQ(rates, std::vector<double>(4, 0.0));
}

TEST(RadialContinuum, FrictionOpposesTheSlidingAndItsPowerIsLost) {
  ClearanceParameters joint = joint_without_friction();
  joint.friction = FrictionParameters{};
  JournalMotion journal = journal_at(joint.c_r + 2e-6, 0.0);
  journal.w = {0.0, 0.0, 20.0};
  std::vector<double> rates(4);
  const ContactLoad load = calc_load(RadialContinuum(joint), journal, std::vector<double>(4).data(), rates.data());
  const double f_n = 4.78e10 * std::pow(2e-6, 1.5);
  const double v = 20.0 * joint.r_j();
  // Fresh bristles: sigma_1 v is all there is.
  EXPECT_NEAR(load.force.y(), -f_n * 5.0 * v, 1e-8 * f_n);
  EXPECT_NEAR(load.moment.z(), -f_n * 5.0 * v * joint.r_j(), 1e-8 * f_n * joint.r_j());
  EXPECT_NEAR(load.friction_power, f_n * 5.0 * v * v, 1e-8 * f_n);
  EXPECT_NEAR(rates[0], v, 1e-12);
  EXPECT_NEAR(rates[1], 0.0, 1e-12);
}

/// Force and moment of the faces' points one by one, for contacts that have just begun.
ContactLoad sum_all_face_points(const ClearanceParameters& joint, const JournalMotion& journal) {
  const double stiffness = joint.K_a / (joint.n_a * joint.n_ce_axial);
  ContactLoad sum;
  for (const double side : {1.0, -1.0})
    for (int circle = 1; circle <= joint.n_a; ++circle)
      for (int k = 0; k < joint.n_ce_axial; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / joint.n_ce_axial;
        const double radius = joint.r_j() * circle / joint.n_a;
        const Eigen::Vector3d r = journal.R_bj * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), side * 0.5 * joint.L_b);
        const double delta = side * (journal.p_bj + r).z() - 0.5 * joint.L_b - joint.c_a;
        const double rate = side * journal.calc_velocity(r).z();
        if (delta <= 0.0) continue;
        const double f = std::max(0.0, stiffness * delta * (1.0 + joint.chi * rate / std::max(rate, joint.minimum_onset_rate)));
        const Eigen::Vector3d force(0.0, 0.0, -side * f);
        sum.force += force;
        sum.moment += r.cross(force);
        sum.impact_power += (f - stiffness * delta) * rate;
        sum.elastic_energy += 0.5 * stiffness * delta * delta;
      }
  return sum;
}

TEST(AxialFaces, PointsTakenSideBySideActAsOneByOne) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const auto& [circles, points] : {std::pair{1, 8}, {1, 3}, {3, 5}, {2, 8}, {1, 9}}) {
    ClearanceParameters parameters = joint_without_friction();
    parameters.n_a = circles;
    parameters.n_ce_axial = points;
    ClearanceJoint joint(parameters);
    std::vector<double> bristles(static_cast<std::size_t>(joint.bristle_count()), 0.0), rates = bristles;
    int pushed_back = 0;
    for (int trial = 0; trial < 200; ++trial) {
      JournalMotion journal = journal_at(0.0, 0.0);
      journal.p_bj.z() = 2e-6 * uniform(random);
      const Eigen::Vector3d axis(uniform(random), uniform(random), 0.3);
      journal.R_bj = Eigen::AngleAxisd(5e-4 * uniform(random), axis.normalized()).toRotationMatrix();
      journal.v = Eigen::Vector3d(uniform(random), uniform(random), 0.01 * uniform(random));
      journal.w = Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
      const ContactLoad expected = sum_all_face_points(parameters, journal);
      ContactLoad load;
      ASSERT_TRUE(joint.calc(journal, bristles.data(), rates.data(), load));
      const double scale = 1e-9 * (1.0 + expected.force.norm());
      EXPECT_LE((load.force - expected.force).norm(), scale);
      EXPECT_LE((load.moment - expected.moment).norm(), scale * parameters.L_b);
      EXPECT_NEAR(load.impact_power, expected.impact_power, scale);
      EXPECT_NEAR(load.elastic_energy, expected.elastic_energy, scale);
      if (expected.force.norm() > 0.0) ++pushed_back;
    }
    EXPECT_GT(pushed_back, 50) << "few trials touch";
  }
}

ClearanceParameters joint_of_elements(int n_ce) {
  ClearanceParameters joint = joint_without_friction();
  joint.form = RadialForm::kElements;
  joint.n_ce = n_ce;
  joint.friction = FrictionParameters{};
  return joint;
}

/// Normal force of all n_ce elements of each ring, none left out, for a journal at rest.
Eigen::Vector3d sum_all_elements(const ClearanceParameters& joint, const JournalMotion& journal) {
  const double s = joint.K / joint.n_r * 3.0 * std::sqrt(joint.c_r) / (4.0 * std::sqrt(2.0)) * 2.0 * std::numbers::pi / joint.n_ce;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const double z : {-0.5 * joint.L_b, 0.5 * joint.L_b})
    for (int k = 0; k < joint.n_ce; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / joint.n_ce;
      const Eigen::Vector3d p = journal.p_bj + journal.R_bj * Eigen::Vector3d(joint.r_j() * std::cos(angle), joint.r_j() * std::sin(angle), z);
      const double rho = std::hypot(p.x(), p.y());
      if (rho > joint.r_b) sum -= s * (rho - joint.r_b) * Eigen::Vector3d(p.x(), p.y(), 0.0) / rho;
    }
  return sum;
}

TEST(RadialElements, LookingNearTheContactOnlyMissesNoElement) {
  const ClearanceParameters joint = joint_of_elements(180);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int touching = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const double direction = std::numbers::pi * uniform(random);
    const double distance = joint.c_r + 8e-6 * uniform(random);
    JournalMotion journal = journal_at(distance * std::cos(direction), distance * std::sin(direction));
    journal.R_bj = (Eigen::AngleAxisd(std::numbers::pi * uniform(random), Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(1e-3 * uniform(random), Eigen::Vector3d(uniform(random), uniform(random), 0.0).normalized()))
                       .toRotationMatrix();
    RadialElements radial(joint);
    std::vector<double> bristles(static_cast<std::size_t>(radial.bristle_count()));
    std::vector<double> rates(bristles.size());
    radial.follow(journal, 0.0, bristles.data());
    ContactLoad load;
    EXPECT_TRUE(calc_load(radial, journal, bristles.data(), rates.data(), load));
    const Eigen::Vector3d all = sum_all_elements(joint, journal);
    touching += all.norm() > 0.0 ? 1 : 0;
    EXPECT_LT((load.force - all).norm(), 1e-8 * (1.0 + all.norm()));
  }
  EXPECT_GT(touching, 200);
}

TEST(RadialElements, BristlesFollowTheContactAroundTheJournal) {
  const ClearanceParameters joint = joint_of_elements(180);
  RadialElements radial(joint);
  std::vector<double> bristles(static_cast<std::size_t>(radial.bristle_count()));
  std::vector<double> rates(bristles.size());
  const auto at_angle = [&](double angle) { return journal_at((joint.c_r + 4e-6) * std::cos(angle), (joint.c_r + 4e-6) * std::sin(angle)); };
  JournalMotion last = journal_at(0.0, 0.0);
  double most = 0.0;
  for (double angle = 0.0; angle < 13.0; angle += 0.01) {  // twice around
    JournalMotion journal = at_angle(angle);
    journal.w = {0.0, 0.0, 1.0};
    (void)radial.follow(last, 0.0, bristles.data());
    ContactLoad load;
    ASSERT_TRUE(calc_load(radial, journal, bristles.data(), rates.data(), load)) << angle;
    for (std::size_t i = 0; i < bristles.size(); ++i) bristles[i] += 1e-3 * rates[i];
    radial.advance(last, journal, 1e-3, bristles.data());
    for (const double z : bristles) most = std::max(most, std::abs(z));
    last = journal;
  }
  // An element is in contact over an arc of about 0.35 rad, 35 steps, and its bristle grows by at most v dt = 4.75e-6 m in each.
  EXPECT_GT(most, 20 * 4.75e-6);
  EXPECT_LT(most, 45 * 4.75e-6);
}

// Single elements of a lasting contact, and points of faces, leave the equations of motion nearly as they were. No other contact does.
TEST(ClearanceJoint, TellsSmallChangesFromAbruptOnes) {
  ClearanceParameters parameters = joint_of_elements(360);
  parameters.c_a = 10e-6;
  ClearanceJoint joint(parameters);
  const auto c_r = parameters.c_r;
  std::vector<double> bristles(static_cast<std::size_t>(joint.bristle_count()));
  JournalMotion last = journal_at(0.0, 0.0);
  const auto move_to = [&](const JournalMotion& next) {
    (void)joint.follow(next, 0.0, bristles.data());
    return joint.advance(std::exchange(last, next), next, 1e-5, bristles.data());
  };
  const auto expect = [](const ContactChange& change, bool any, bool abrupt, int ring_onsets) {
    EXPECT_EQ(change.any, any);
    EXPECT_EQ(change.abrupt, abrupt);
    EXPECT_EQ(change.ring_onsets, ring_onsets);
  };
  expect(move_to(journal_at(c_r - 1e-6, 0.0)), false, false, 0);
  expect(move_to(journal_at(c_r + 2e-6, 0.0)), true, true, parameters.n_r);
  expect(move_to(journal_at(c_r + 2e-6, 0.0)), false, false, 0);
  expect(move_to(journal_at(c_r + 4e-6, 0.0)), true, false, 0);          // elements more
  expect(move_to(journal_at(c_r + 1e-6, 0.0)), true, false, 0);          // fewer
  expect(move_to(journal_at(c_r + 1e-6, 0.0, 11e-6)), true, false, 0);   // a face
  expect(move_to(journal_at(c_r + 1e-6, 0.0)), true, false, 0);
  expect(move_to(journal_at(c_r - 1e-6, 0.0)), true, true, 0);           // contact lost
}

// With Kelvin and Voigt's damping the force of a point begins with a jump.
TEST(ClearanceJoint, ADampedFaceChangesAbruptly) {
  for (const double damping : {0.0, 300.0}) {
    ClearanceParameters parameters = joint_without_friction();
    parameters.c_a = 10e-6;
    parameters.damping = damping;
    ClearanceJoint joint(parameters);
    std::vector<double> bristles(static_cast<std::size_t>(joint.bristle_count()));
    const ContactChange change = joint.advance(journal_at(0.0, 0.0), journal_at(0.0, 0.0, 11e-6), 1e-5, bristles.data());
    EXPECT_TRUE(change.any);
    EXPECT_EQ(change.abrupt, damping > 0.0);
  }
}

TEST(ClearanceJoint, AllChangesOfAContinuumAreAbrupt) {
  ClearanceJoint joint(joint_without_friction());
  std::vector<double> bristles(static_cast<std::size_t>(joint.bristle_count()));
  const double c_r = joint_without_friction().c_r;
  for (const auto& [from, to] : {std::pair{-1e-6, 1e-6}, {1e-6, -1e-6}}) {
    const ContactChange change = joint.advance(journal_at(c_r + from, 0.0), journal_at(c_r + to, 0.0), 1e-5, bristles.data());
    EXPECT_TRUE(change.any);
    EXPECT_TRUE(change.abrupt);
  }
}

TEST(RadialElements, AWiderWindowHoldsTheSameBristles) {
  const ClearanceParameters joint = joint_of_elements(360);
  RadialElements radial(joint);
  std::vector<double> bristles(static_cast<std::size_t>(radial.bristle_count()));
  for (std::size_t i = 0; i < bristles.size(); ++i) bristles[i] = 1e-6 * static_cast<double>(i % 17);
  const JournalMotion journal = journal_at(joint.c_r + 4e-6, 0.0);
  (void)radial.follow(journal, 0.0, bristles.data());
  ContactLoad before, after;
  std::vector<double> rates(bristles.size());
  ASSERT_TRUE(calc_load(radial, journal, bristles.data(), rates.data(), before));
  ASSERT_GT(before.friction_sum, 0.0);
  const Eigen::VectorXd wide = radial.widen(bristles.data());
  ASSERT_GT(wide.size(), static_cast<Eigen::Index>(bristles.size()));
  rates.resize(static_cast<std::size_t>(wide.size()));
  ASSERT_TRUE(calc_load(radial, journal, wide.data(), rates.data(), after));
  EXPECT_EQ(before.force, after.force);
}

TEST(MotionSystem, TellsElementsOfALastingContactFromAbruptChanges) {
  RpsupParameters parameters = validation::across_rpsup();
  parameters.contact = ContactForm::kElements;
  parameters.radial_elements = 720;
  parameters.c_a = 1e-3;  // faces stay apart
  const Mechanism mechanism = build_rpsup(parameters).mechanism;
  MotionSystem system(mechanism);
  Evaluation assembled = system.make_evaluation();
  ASSERT_TRUE(LoopClosure(mechanism).assemble(0.0, assembled));
  Eigen::VectorXd y, f;
  const auto evaluate = [&](double lift) {
    Eigen::VectorXd q = assembled.q;
    q[2] += lift;
    y = system.make_state(q, assembled.qd);
    f.setZero(y.size());
    Evaluation at = system.make_evaluation();
    for (const bool again : {false, true}) {  // where the bristles have followed
      if (again) (void)system.prepare_step(at, 0.0, y);
      const EvaluationStatus status = system.calc_derivative(0.0, y, f, at);
      EXPECT_TRUE(!again || status == EvaluationStatus::kOk);
    }
    return at;
  };
  Evaluation last = evaluate(0.0);
  const auto move_to = [&](double lift) {
    Evaluation next = evaluate(lift);
    next.t = last.t + 1e-5;
    const ContactChange change = system.accept_step(last, next, y);
    last = std::move(next);
    return change;
  };
  EXPECT_FALSE(move_to(0.53e-3).any);
  EXPECT_TRUE(move_to(0.545e-3).abrupt);                   // one ring, 2 um deep
  const ContactChange deeper = move_to(0.548e-3);          // 3 um
  EXPECT_TRUE(deeper.any);
  EXPECT_FALSE(deeper.abrupt);
  EXPECT_TRUE(move_to(0.556e-3).abrupt);                   // the other ring, too
}

// Remains of a missed element must not reach the next evaluation.
TEST(RadialElements, AMissLeavesTheNextEvaluationAlone) {
  RpsupParameters parameters = validation::across_rpsup();
  parameters.contact = ContactForm::kElements;
  parameters.radial_elements = 720;
  const Mechanism mechanism = build_rpsup(parameters).mechanism;
  MotionSystem system(mechanism);
  Evaluation at = system.make_evaluation();
  ASSERT_TRUE(LoopClosure(mechanism).assemble(0.0, at));
  const auto state = [&](double lift) {
    Eigen::VectorXd q = at.q;
    q[2] += lift;
    Eigen::VectorXd qd = at.qd;
    qd[2] = 0.1;
    return system.make_state(q, qd);
  };
  const Eigen::VectorXd shallow = state(0.555e-3);  // 7 um deep
  const Eigen::VectorXd deep = state(1e-3);         // 0.2 mm deep: nearly half of the journal is outside
  Evaluation scratch = system.make_evaluation();
  Eigen::VectorXd f = Eigen::VectorXd::Zero(shallow.size());
  (void)system.calc_derivative(0.0, shallow, f, scratch);
  Eigen::VectorXd y = shallow;
  (void)system.prepare_step(scratch, 0.0, y);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(y.size());
  ASSERT_EQ(system.calc_derivative(0.0, y, before, scratch), EvaluationStatus::kOk);
  ASSERT_EQ(system.calc_derivative(0.0, deep, f, scratch), EvaluationStatus::kBristleMissing);
  system.widen_bristles(y);
  Eigen::VectorXd after = Eigen::VectorXd::Zero(y.size());
  ASSERT_EQ(system.calc_derivative(0.0, y, after, scratch), EvaluationStatus::kOk);
  const Eigen::Index mechanical = 2 * system.free_count();
  EXPECT_GT(before.head(mechanical).norm(), 100.0);  // the contact accelerates
  EXPECT_EQ(Eigen::VectorXd(after.head(mechanical)), Eigen::VectorXd(before.head(mechanical)));
}

}  // namespace
}  // namespace engine
