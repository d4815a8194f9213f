// Contact of a whole journal: statics, closed forms, and the pruned ring of elements against all of its elements.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/clearance/axial_faces.h"
#include "engine/clearance/clearance_joint.h"
#include "engine/clearance/radial_continuum.h"
#include "engine/clearance/radial_elements.h"
#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"

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

TEST(RadialContinuum, PressesWithHertzsForceAgainstTheOffset) {
  const ClearanceParameters joint = joint_without_friction();
  const RadialContinuum radial(joint);
  ContactLoad load;
  std::vector<double> rates(4);
  const double delta = 3e-6;
  radial.calc(journal_at(0.6 * (joint.c_r + delta), 0.8 * (joint.c_r + delta)), std::vector<double>(4).data(), rates.data(), load);
  const double force = 4.78e10 * std::pow(delta, 1.5);
  EXPECT_NEAR(load.radial_normal_sum, force, 1e-9 * force);
  EXPECT_NEAR(load.force.x(), -0.6 * force, 1e-9 * force);
  EXPECT_NEAR(load.force.y(), -0.8 * force, 1e-9 * force);
  EXPECT_NEAR(load.moment.norm(), 0.0, 1e-12 * force);  // two rings at +-10 mm cancel
  EXPECT_NEAR(load.elastic_energy, 0.4 * force * delta, 1e-9 * force * delta);
  EXPECT_NEAR(load.max_penetration, delta, 1e-15);
}

// Statics of a tilted journal: only the ring that the tilt brings to the bore presses, at its own arm.
TEST(RadialContinuum, ATiltedJournalPressesAtTheRingThatTouches) {
  const ClearanceParameters joint = joint_without_friction();
  const RadialContinuum radial(joint);
  const double tilt = 1e-3;
  JournalMotion journal = journal_at(joint.c_r - 8e-6, 0.0);
  journal.R_bj = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();  // +z end goes to +x by 10 um
  ContactLoad load;
  std::vector<double> rates(4);
  radial.calc(journal, std::vector<double>(4).data(), rates.data(), load);
  const double delta = 0.01 * std::sin(tilt) - 8e-6;
  const double force = 0.5 * 4.78e10 * std::pow(delta, 1.5);
  EXPECT_NEAR(load.force.x(), -force, 1e-8 * force);
  EXPECT_NEAR(load.moment.y(), -force * 0.01 * std::cos(tilt), 1e-8 * force * 0.01);
}

TEST(RadialContinuum, NothingTouchesInsideTheClearance) {
  const ClearanceParameters joint = joint_without_friction();
  ContactLoad load;
  std::vector<double> rates(4, 7.0);
  RadialContinuum(joint).calc(journal_at(0.9 * joint.c_r, 0.0), std::vector<double>(4).data(), rates.data(), load);
  EXPECT_EQ(load.force.norm(), 0.0);
  EXPECT_EQ(rates, std::vector<double>(4, 0.0));
}

TEST(RadialContinuum, FrictionOpposesTheSlidingAndItsPowerIsLost) {
  ClearanceParameters joint = joint_without_friction();
  joint.friction = LuGreParameters{};
  JournalMotion journal = journal_at(joint.c_r + 2e-6, 0.0);
  journal.w = {0.0, 0.0, 20.0};
  ContactLoad load;
  std::vector<double> rates(4);
  RadialContinuum(joint).calc(journal, std::vector<double>(4).data(), rates.data(), load);
  const double f_n = 4.78e10 * std::pow(2e-6, 1.5);
  const double v = 20.0 * joint.r_j();
  // Fresh bristles: sigma_1 v is all there is.
  EXPECT_NEAR(load.force.y(), -f_n * 5.0 * v, 1e-8 * f_n);
  EXPECT_NEAR(load.moment.z(), -f_n * 5.0 * v * joint.r_j(), 1e-8 * f_n * joint.r_j());
  EXPECT_NEAR(load.friction_power, f_n * 5.0 * v * v, 1e-8 * f_n);
  EXPECT_NEAR(rates[0], v, 1e-12);
  EXPECT_NEAR(rates[1], 0.0, 1e-12);
}

TEST(AxialFaces, TheClearanceDecidesWhenTheyTouch) {
  ClearanceParameters joint = joint_without_friction();
  joint.c_a = 5e-6;
  const AxialFaces faces(joint);
  ContactLoad load;
  faces.calc(journal_at(0.0, 0.0, 4.9e-6), load);
  EXPECT_EQ(load.force.norm(), 0.0);
  faces.calc(journal_at(0.0, 0.0, 6e-6), load);
  EXPECT_NEAR(load.force.z(), -1e8 * 1e-6, 1e-6);
  ContactLoad other_side;
  faces.calc(journal_at(0.0, 0.0, -6e-6), other_side);
  EXPECT_NEAR(other_side.force.z(), 1e8 * 1e-6, 1e-6);
}

TEST(AxialFaces, ATiltedFacePressesBackWithTheSpringsOfItsRaisedHalf) {
  const ClearanceParameters joint = joint_without_friction();
  JournalMotion journal;
  journal.R_bj = Eigen::AngleAxisd(1e-4, Eigen::Vector3d::UnitX()).toRotationMatrix();
  ContactLoad load;
  AxialFaces(joint).calc(journal, load);
  // Points of both faces at r_j sin(angle) above the middle: K_a / 8 each, three raised on each face (45, 90, 135 degrees).
  const double r = joint.r_j();
  const double sum_of_squares = 2.0 * (1.0 + 0.5 + 0.5);
  EXPECT_NEAR(load.moment.x(), -1e8 / 8.0 * 1e-4 * r * r * sum_of_squares, 2e-4 * 1e8 * 1e-4 * r * r);
  EXPECT_NEAR(load.force.z(), 0.0, 1e-9);
}

ClearanceParameters joint_of_elements(int n_ce) {
  ClearanceParameters joint = joint_without_friction();
  joint.form = RadialForm::kElements;
  joint.n_ce = n_ce;
  joint.friction = LuGreParameters{};
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
    EXPECT_TRUE(radial.calc(journal, bristles.data(), rates.data(), load));
    const Eigen::Vector3d all = sum_all_elements(joint, journal);
    touching += all.norm() > 0.0 ? 1 : 0;
    EXPECT_LT((load.force - all).norm(), 1e-8 * (1.0 + all.norm()));
  }
  EXPECT_GT(touching, 200);
}

/// Largest relative difference of the ring's force from Hertz's over directions between two elements.
struct RingError {
  double scatter;  ///< over the directions
  double mean;
};
RingError calc_ring_error(int n_ce, double delta) {
  const ClearanceParameters joint = joint_of_elements(n_ce);
  double least = 1e9, most = 0.0, sum = 0.0;
  for (int k = 0; k < 16; ++k) {
    const double direction = 0.3 + 2.0 * std::numbers::pi / n_ce * k / 16.0;
    const double distance = joint.c_r + delta;
    const Eigen::Vector3d force = sum_all_elements(joint, journal_at(distance * std::cos(direction), distance * std::sin(direction)));
    const double ratio = force.norm() / (joint.K * std::pow(delta, 1.5));
    least = std::min(least, ratio);
    most = std::max(most, ratio);
    sum += ratio / 16.0;
  }
  return {most - least, sum - 1.0};
}

// A ring of elements is a sum for an integral whose integrand ends in a kink: what depends on where the elements stand falls
// like n_ce^-2.
TEST(RadialElements, TheirPlacesMatterLessAsTheyBecomeMore) {
  for (const double delta : {1e-6, 5e-6}) {
    const double coarse = calc_ring_error(180, delta).scatter;
    const double fine = calc_ring_error(1440, delta).scatter;
    EXPECT_LT(fine, coarse / 32.0) << delta;  // 8^2 = 64, with room for where the last element stands
  }
  EXPECT_LT(calc_ring_error(180, 5e-6).scatter, 0.006);
}

// In the limit the ring is Hertz's law but for terms of the order of delta / c_r: the stiffness is derived for a shallow arc.
TEST(RadialElements, TendToHertzsLawForShallowContacts) {
  const double deep = calc_ring_error(20'000, 5e-6).mean;
  const double shallow = calc_ring_error(20'000, 0.5e-6).mean;
  EXPECT_LT(std::abs(deep), 0.02);
  // r_b is not r_j: a ring against a bore r_b / r_j times wider is off by c_r / (2 r_j) = 2.6 % for every depth.
  EXPECT_NEAR(shallow, 0.026, 0.003);
  EXPECT_NEAR(shallow - deep, 0.5 * (5e-6 - 0.5e-6) / 0.25e-3, 0.004);
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
    ASSERT_TRUE(radial.calc(journal, bristles.data(), rates.data(), load)) << angle;
    for (std::size_t i = 0; i < bristles.size(); ++i) bristles[i] += 1e-3 * rates[i];
    radial.advance(last, journal, 1e-3, bristles.data());
    for (const double z : bristles) most = std::max(most, std::abs(z));
    last = journal;
  }
  // An element is in contact over an arc of about 0.35 rad, 35 steps, and its bristle grows by at most v dt = 4.75e-6 m in each.
  EXPECT_GT(most, 20 * 4.75e-6);
  EXPECT_LT(most, 45 * 4.75e-6);
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
  ASSERT_TRUE(radial.calc(journal, bristles.data(), rates.data(), before));
  ASSERT_GT(before.friction_sum, 0.0);
  const Eigen::VectorXd wide = radial.widen(bristles.data());
  ASSERT_GT(wide.size(), static_cast<Eigen::Index>(bristles.size()));
  rates.resize(static_cast<std::size_t>(wide.size()));
  ASSERT_TRUE(radial.calc(journal, wide.data(), rates.data(), after));
  EXPECT_EQ(before.force, after.force);
}

// What a missed element leaves behind must not reach the next evaluation.
TEST(RadialElements, AMissLeavesTheNextEvaluationAlone) {
  RpsupParameters parameters;
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
  const Eigen::VectorXd shallow = state(0.51e-3);  // 5 um deep
  const Eigen::VectorXd deep = state(1e-3);        // 0.25 mm deep: half of the journal is outside
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
