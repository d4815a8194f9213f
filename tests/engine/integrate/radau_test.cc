// SPDX-License-Identifier: Apache-2.0
// Radau IIA of order 5: its coefficients by their definition, its accuracy, and what it takes from one step to the next.

#include <array>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "engine/integrate/choose_integrator.h"
#include "engine/integrate/radau.h"
#include "engine/integrate/radau_coefficients.h"
#include "engine/model/rpsup.h"
#include "tests/engine/pendulum.h"

namespace engine {
namespace {

using K = RadauCoefficients;
constexpr double kDigits = 1e-14;

Eigen::Matrix3d matrix(const std::array<K::Row, 3>& rows) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i) m.row(i) = Eigen::RowVector3d::Map(rows[static_cast<std::size_t>(i)].data());
  return m;
}

/// A, from its points alone: sum_j a_ij c_j^k = c_i^(k+1) / (k + 1), k = 0, 1, 2.
Eigen::Matrix3d collocate() {
  Eigen::Matrix3d powers, integrals;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) {
      const double c = K::c[static_cast<std::size_t>(i)];
      powers(i, k) = std::pow(c, k);
      integrals(i, k) = std::pow(c, k + 1) / (k + 1);
    }
  return integrals * powers.inverse();
}

TEST(RadauCoefficients, AreThoseOfAQuadratureOfOrder5ThatEndsAtTheEnd) {
  const Eigen::RowVector3d b = collocate().row(2);
  const auto c = Eigen::Array3d::Map(K::c.data());
  EXPECT_EQ(K::c.back(), 1.0);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(b.dot(c.pow(k).matrix()), 1.0 / (k + 1), kDigits) << k;
  EXPECT_GT(std::abs(b.dot(c.pow(5).matrix()) - 1.0 / 6.0), 1e-3);
}

TEST(RadauCoefficients, DecoupleTheStages) {
  const Eigen::Matrix3d T = matrix(K::T);
  const Eigen::Matrix3d T_inverse = matrix(K::T_inverse);
  EXPECT_LT((T * T_inverse - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), kDigits);
  Eigen::Matrix3d blocks;
  blocks << K::shift, 0.0, 0.0, 0.0, K::complex_shift.real(), -K::complex_shift.imag(), 0.0, K::complex_shift.imag(), K::complex_shift.real();
  EXPECT_LT((T_inverse * collocate().inverse() * T - blocks).cwiseAbs().maxCoeff(), 1e-12);
}

// The other method has f at the start for one more point. Its weights: that of the start, and b + A^T e.
TEST(RadauCoefficients, CompareWithAMethodOfOrder3) {
  const Eigen::Matrix3d A = collocate();
  const Eigen::Vector3d e = Eigen::Vector3d::Map(K::error.data()) / K::shift;
  const Eigen::Vector3d weights = A.row(2).transpose() + A.transpose() * e;
  const auto c = Eigen::Array3d::Map(K::c.data());
  EXPECT_NEAR(weights.sum() + 1.0 / K::shift, 1.0, kDigits);
  EXPECT_NEAR(weights.dot(c.matrix()), 1.0 / 2.0, kDigits);
  EXPECT_NEAR(weights.dot(c.square().matrix()), 1.0 / 3.0, kDigits);
  EXPECT_GT(std::abs(weights.dot(c.cube().matrix()) - 1.0 / 4.0), 1e-3);
}

/// A method at the start of a motion.
class Start {
 public:
  explicit Start(double accuracy) : tolerance(accuracy, accuracy) {
    start.y = system.make_state(Eigen::Vector2d(1.0, -0.5), Eigen::Vector2d(3.0, -2.0));
    start.f = Eigen::VectorXd::Zero(start.y.size());
    start.at = end.at = again.at = system.make_evaluation();
    EXPECT_EQ(system.calc_derivative(0.0, start.y, start.f, start.at), EvaluationStatus::kOk);
    tolerance.set_radii(mechanism, system.free_coordinates(), start.at.frames);
  }

  Mechanism mechanism = make_pendulum();
  MotionSystem system{mechanism};
  Tolerance tolerance;
  StepPoint start, end, again;
};

TEST(Radau5, GivesTheSameFromTheSameStart) {
  Start at(1e-6);
  Radau5 method(at.tolerance);
  ASSERT_LE(method.try_step(at.system, at.start, 1e-3, at.end).error, 1.0);
  EXPECT_GT(method.try_step(at.system, at.start, 0.5, at.again).error, 1.0);
  ASSERT_LE(method.try_step(at.system, at.start, 1e-3, at.again).error, 1.0);
  EXPECT_LT((at.again.y - at.end.y).norm(), 1e-9);  // one more or less of the iterations
  method.invalidate();
  ASSERT_LE(method.try_step(at.system, at.start, 1e-3, at.again).error, 1.0);
  StepPoint of_new = at.end;
  ASSERT_LE(Radau5(at.tolerance).try_step(at.system, at.start, 1e-3, of_new).error, 1.0);
  EXPECT_LT((at.again.y - of_new.y).norm(), 1e-9);
}

TEST(Radau5, GoesOnFromTheStepBeforeWithFewerEvaluations) {
  Start at(1e-6);
  Radau5 method(at.tolerance);
  const Trial first = method.try_step(at.system, at.start, 1e-3, at.end);
  ASSERT_LE(first.error, 1.0);
  method.accept();
  const Trial next = method.try_step(at.system, at.end, 1e-3, at.again);
  ASSERT_LE(next.error, 1.0);
  method.invalidate();
  StepPoint anew = at.again;
  const Trial without = method.try_step(at.system, at.end, 1e-3, anew);
  ASSERT_LE(without.error, 1.0);
  EXPECT_LT(next.evaluations, without.evaluations);
  EXPECT_LT((anew.y - at.again.y).norm(), 1e-11);  // an old Jacobian changes the way there, not what is found
}

// The finest tolerances ask for less than roundings of the state.
TEST(Radau5, TakesStepsAtTheFinestTolerance) {
  Start at(1e-13);
  Radau5 method(at.tolerance);
  double dt = 1e-4;
  for (int k = 0; k < 20; ++k) {
    const Trial trial = method.try_step(at.system, at.start, dt, at.end);
    ASSERT_LE(trial.error, 1.0) << k;
    ASSERT_LE(trial.evaluations, 3 * 4 + 1) << k;
    method.accept();
    std::swap(at.start, at.end);
  }
}

// A spring of 1e10 N/m lets go of a mass too far out: steps of a thousand of its periods find where it comes to rest.
TEST(Radau5, StepsOverWhatIsStiffAndAtRest) {
  Mechanism m;
  m.coordinates.push_back({.name = "slide", .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kX, .stiffness = 1e10, .mass = 1.0,
                           .com = Eigen::Vector3d::Zero(), .inertia = Eigen::Matrix3d::Identity()});
  m.gravity_W = {9.81, 0.0, 0.0};
  MotionSystem system(m);
  const Tolerance tolerance(1e-5, 1e-5);
  StepPoint start, end;
  start.y = system.make_state(Eigen::VectorXd::Constant(1, 3e-9), Eigen::VectorXd::Zero(1));  // at rest it is 9.81e-10 m long
  start.f = Eigen::VectorXd::Zero(start.y.size());
  start.at = end.at = system.make_evaluation();
  ASSERT_EQ(system.calc_derivative(0.0, start.y, start.f, start.at), EvaluationStatus::kOk);
  Radau5 method(tolerance);
  for (int k = 0; k < 3; ++k) {
    ASSERT_LE(method.try_step(system, start, 0.1, end).error, 1.0);
    method.accept();
    std::swap(start, end);
  }
  EXPECT_NEAR(start.y[0], 9.81e-10, 1e-14);
}

TEST(ChooseIntegrator, TakesDopri5OnlyWhereFrictionHasNoBristlesAndLinksAreRigid) {
  const auto choose = [](const RpsupParameters& p, Integrator wanted) {
    return choose_integrator(build_rpsup(p).mechanism, wanted);
  };
  RpsupParameters study, coulomb, flexible, ideal;
  coulomb.friction = flexible.friction = ideal.friction = FrictionLaw::kCoulomb;
  flexible.coupler = Coupler::kFlexible;
  ideal.c_r = 0.0;
  EXPECT_EQ(choose(study, Integrator::kAuto), Integrator::kRadau5);
  EXPECT_EQ(choose(coulomb, Integrator::kAuto), Integrator::kDopri5);
  EXPECT_EQ(choose(flexible, Integrator::kAuto), Integrator::kRadau5);
  EXPECT_EQ(choose(ideal, Integrator::kAuto), Integrator::kRadau5);
  EXPECT_EQ(choose(coulomb, Integrator::kRk4), Integrator::kRk4);
}

TEST(ChooseLongestStep, IsShorterWhereFrictionMayFeedVibrations) {
  const auto choose = [](const RpsupParameters& p, Integrator integrator) { return choose_longest_step(build_rpsup(p).mechanism, integrator); };
  RpsupParameters rigid, flexible, quick, frictionless, ideal;
  flexible.coupler = Coupler::kFlexible;
  quick.sigma_0 = 301.0;
  frictionless.friction = FrictionLaw::kNone;
  ideal.c_r = 0.0;
  EXPECT_LT(choose(flexible, Integrator::kRadau5), choose(rigid, Integrator::kRadau5));
  // About half a period of the fastest vibrations of links that friction was seen to excite, 1.3 kHz.
  EXPECT_LT(choose(flexible, Integrator::kRadau5), 0.55 / 1300.0);
  EXPECT_LT(choose(quick, Integrator::kRadau5), choose(flexible, Integrator::kRadau5));
  quick.sigma_0 = 100.0;
  quick.friction = FrictionLaw::kCoulomb;
  EXPECT_LT(choose(quick, Integrator::kRadau5), choose(flexible, Integrator::kRadau5));
  EXPECT_EQ(choose(frictionless, Integrator::kRadau5), choose(rigid, Integrator::kRadau5));
  EXPECT_EQ(choose(flexible, Integrator::kRodas5), choose(rigid, Integrator::kRodas5));
  EXPECT_GT(choose(ideal, Integrator::kRadau5), choose(rigid, Integrator::kRadau5));
  EXPECT_EQ(choose(ideal, Integrator::kDopri5), choose(rigid, Integrator::kDopri5));
}

TEST(ChooseTolerance, IsFinerWithClearance) {
  const auto choose = [](const RpsupParameters& p, double wanted) { return choose_tolerance(build_rpsup(p).mechanism, wanted); };
  RpsupParameters study, worn, quick, coulomb, frictionless;
  worn.wear_depth.assign(2, std::vector<double>(24, 1e-5));
  quick.sigma_0 = 301.0;
  coulomb.friction = FrictionLaw::kCoulomb;
  frictionless.friction = FrictionLaw::kNone;
  EXPECT_DOUBLE_EQ(choose(study, 1.5e-5), 7.5e-6);
  EXPECT_DOUBLE_EQ(choose(worn, 1.5e-5), 2e-6);
  EXPECT_DOUBLE_EQ(choose(quick, 1.5e-5), 5e-7);
  EXPECT_DOUBLE_EQ(choose(coulomb, 1.5e-5), 1e-9);
  EXPECT_DOUBLE_EQ(choose(frictionless, 1.5e-5), 5e-7);
  RpsupParameters elements = study;
  elements.contact = coulomb.contact = ContactForm::kElements;
  EXPECT_DOUBLE_EQ(choose(elements, 1.5e-5), 7.5e-6);
  EXPECT_DOUBLE_EQ(choose(coulomb, 1.5e-5), 1e-9);
  coulomb.contact = ContactForm::kContinuum;
  EXPECT_EQ(choose(coulomb, 1e-10), 1e-10);
  EXPECT_EQ(choose(coulomb, 1e-13), 1e-13);
  for (double wanted = 1e-12; wanted < 1e-2; wanted *= 2.0) EXPECT_LT(choose(frictionless, wanted), choose(frictionless, 1.9 * wanted)) << wanted;
  elements.c_r = 0.0;
  EXPECT_EQ(choose(elements, 1.5e-5), 1.5e-5);
}

}  // namespace
}  // namespace engine
