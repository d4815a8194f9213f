// SPDX-License-Identifier: Apache-2.0
// Samples, interpolation and events on problems whose answer is known. Orders and instants of contact: validation/integrators.

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/integrate/contact_events.h"
#include "engine/integrate/integration.h"
#include "engine/integrate/interpolation.h"
#include "engine/integrate/odeint_steppers.h"
#include "engine/model/mechanism.h"
#include "engine/simulate.h"
#include "tests/engine/pendulum.h"

namespace engine {
namespace {

class LastState : public Observer {
 public:
  void on_step(const Evaluation&, const Evaluation& end) override { q = end.q; }
  void on_sample(const Evaluation& at) override {
    times.push_back(at.t);
    sampled_q.push_back(at.q[0]);
    balance.push_back(at.energy.calc_balance());
  }
  void on_onsets(int, int) override {}
  bool stop_requested(double) override { return false; }
  Eigen::VectorXd q;
  std::vector<double> times, sampled_q, balance;
};

TEST(Integration, SamplesAtEachMultipleAndAtTheEnd) {
  LastState observer;
  ASSERT_EQ(simulate(make_pendulum(), {.duration = 0.0255, .output_rate = 1000.0}, observer).status, RunStatus::kSucceeded);
  ASSERT_EQ(observer.times.size(), 27u);  // 0, 1 ms, ... 25 ms and the end
  EXPECT_DOUBLE_EQ(observer.times[13], 0.013);
  EXPECT_DOUBLE_EQ(observer.times.back(), 0.0255);
  EXPECT_DOUBLE_EQ(observer.sampled_q.front(), 1.0);
  EXPECT_EQ(observer.sampled_q.back(), observer.q[0]);
}

TEST(Integration, SamplesBetweenStepsLieOnTheSolution) {
  // Steps of 4 ms, samples each 1 ms, against steps of 1 ms that end on the samples.
  LastState coarse, fine;
  const RunOptions options{.duration = 0.4, .integrator = Integrator::kRk4, .step = 4e-3};
  ASSERT_EQ(simulate(make_pendulum(), options, coarse).status, RunStatus::kSucceeded);
  RunOptions small = options;
  small.step = 1e-3;
  ASSERT_EQ(simulate(make_pendulum(), small, fine).status, RunStatus::kSucceeded);
  ASSERT_EQ(coarse.times.size(), fine.times.size());
  for (std::size_t k = 0; k < coarse.times.size(); ++k) {
    EXPECT_NEAR(coarse.sampled_q[k], fine.sampled_q[k], 1e-8) << coarse.times[k];
    EXPECT_NEAR(coarse.balance[k], coarse.balance[0], 2e-7) << coarse.times[k];  // RK4 itself drifts by 1.2e-7 J at 4 ms
  }
}

// 3 x 19 ms fall 7e-18 s short of 57 ms.
TEST(Integration, TakesNoStepOfOneRounding) {
  LastState observer;
  const RunOutcome end = simulate(make_pendulum(), {.duration = 0.057, .integrator = Integrator::kRk4, .step = 0.019}, observer);
  EXPECT_EQ(end.steps, 3);
  EXPECT_EQ(end.t, 0.057);
  EXPECT_EQ(observer.times.back(), 0.057);
}

// One Jacobian serves all tries of a step, and a rejected try is not evaluated at its end.
TEST(Rodas, AgreesWithDopri5AsCloselyAsItsTolerance) {
  LastState exact;
  const RunOptions tight{.duration = 0.4, .integrator = Integrator::kDopri5, .relative_tolerance = 1e-12, .absolute_tolerance = 1e-12};
  ASSERT_EQ(simulate(make_pendulum(), tight, exact).status, RunStatus::kSucceeded);
  constexpr int kStages = 8;
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    LastState observer;
    const RunOptions options{.duration = 0.4, .integrator = Integrator::kRodas5, .relative_tolerance = tolerance,
                             .absolute_tolerance = tolerance};
    const RunOutcome end = simulate(make_pendulum(), options, observer);
    ASSERT_EQ(end.status, RunStatus::kSucceeded);
    // All stages but the first, and the end; one more at t = 0.
    EXPECT_GE(end.evaluations, kStages * end.steps + 1);
    EXPECT_LE(end.evaluations, kStages * end.steps + 1 + (kStages - 1) * (end.steps / 4));
    ASSERT_EQ(observer.sampled_q.size(), exact.sampled_q.size());
    for (std::size_t k = 0; k < exact.sampled_q.size(); ++k)
      EXPECT_NEAR(observer.sampled_q[k], exact.sampled_q[k], tolerance) << tolerance;
  }
}

TEST(Radau, AgreesWithDopri5AsCloselyAsItsTolerance) {
  LastState exact;
  const RunOptions tight{.duration = 0.4, .integrator = Integrator::kDopri5, .relative_tolerance = 1e-12, .absolute_tolerance = 1e-12};
  ASSERT_EQ(simulate(make_pendulum(), tight, exact).status, RunStatus::kSucceeded);
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    LastState observer;
    const RunOptions options{.duration = 0.4, .integrator = Integrator::kRadau5, .relative_tolerance = tolerance, .absolute_tolerance = tolerance};
    ASSERT_EQ(simulate(make_pendulum(), options, observer).status, RunStatus::kSucceeded);
    ASSERT_EQ(observer.sampled_q.size(), exact.sampled_q.size());
    for (std::size_t k = 0; k < exact.sampled_q.size(); ++k) EXPECT_NEAR(observer.sampled_q[k], exact.sampled_q[k], tolerance) << tolerance;
  }
}

TEST(Rodas, StepsFromTheSameStartGiveTheSame) {
  const Mechanism mechanism = make_pendulum();
  MotionSystem system(mechanism);
  StepPoint start, end, again;
  start.y = system.make_state(Eigen::Vector2d(1.0, -0.5), Eigen::Vector2d(3.0, -2.0));
  start.f = Eigen::VectorXd::Zero(start.y.size());
  start.at = end.at = again.at = system.make_evaluation();
  ASSERT_EQ(system.calc_derivative(0.0, start.y, start.f, start.at), EvaluationStatus::kOk);
  Tolerance tolerance(1e-6, 1e-6);
  tolerance.set_radii(mechanism, system.free_coordinates(), start.at.frames);
  Rodas5 method(tolerance);
  ASSERT_EQ(method.try_step(system, start, 1e-3, end).evaluations, 8);
  const Trial rejected = method.try_step(system, start, 0.5, again);
  EXPECT_GT(rejected.error, 1.0);
  EXPECT_EQ(rejected.evaluations, 7);
  ASSERT_EQ(method.try_step(system, start, 1e-3, again).status, EvaluationStatus::kOk);
  EXPECT_EQ(again.y, end.y);
  EXPECT_EQ(again.f, end.f);

  // Another start is one behind accept(): its own Jacobian then, the same as a new method's.
  method.accept();
  StepPoint next;
  next.at = start.at;
  next.f = start.f;
  ASSERT_EQ(method.try_step(system, end, 0.02, next).status, EvaluationStatus::kOk);
  ASSERT_EQ(Rodas5(tolerance).try_step(system, end, 0.02, again).status, EvaluationStatus::kOk);
  EXPECT_EQ(again.y, next.y);
}

TEST(Interpolation, IsExactForAQuinticMotion) {
  // q = t^5 - t^3 + 2 over [0, 2]: q, qd, qdd at both ends give it back.
  const auto q = [](double t) { return std::pow(t, 5) - std::pow(t, 3) + 2.0; };
  const auto qd = [](double t) { return 5.0 * std::pow(t, 4) - 3.0 * t * t; };
  const auto qdd = [](double t) { return 20.0 * std::pow(t, 3) - 6.0 * t; };
  StepPoint start, end;
  end.t = 2.0;
  start.y = Eigen::Vector2d(q(0.0), qd(0.0));
  start.f = Eigen::Vector2d(qd(0.0), qdd(0.0));
  end.y = Eigen::Vector2d(q(2.0), qd(2.0));
  end.f = Eigen::Vector2d(qd(2.0), qdd(2.0));
  Eigen::VectorXd y;
  for (const double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    interpolate_state(start, end, {.free = 1}, s, y);
    EXPECT_NEAR(y[0], q(2.0 * s), 1e-13);
    EXPECT_NEAR(y[1], qd(2.0 * s), 1e-12);
  }
}

std::vector<Penetration> one(double delta, double rate) { return {{delta, rate}}; }

TEST(ContactEvents, EndAStepJustBeyondTheOnset) {
  // Constant approach at 0.5 m/s, onset in the middle of a step of 2 us.
  const auto until = ContactEvents::find_first(one(-0.5e-6, 0.5), one(0.5e-6, 0.5), 2e-6);
  ASSERT_TRUE(until);
  EXPECT_GT(*until, 1e-6);
  EXPECT_NEAR(0.5 * (*until - 1e-6), 0.5 * ContactEvents::kBand, 1e-15);
}

TEST(ContactEvents, EndAStepJustBeyondTheParting) {
  const auto until = ContactEvents::find_first(one(1e-6, -0.5), one(-1e-6, -0.5), 4e-6);
  ASSERT_TRUE(until);
  EXPECT_NEAR(*until, 2e-6 + 1e-10, 1e-12);
}

TEST(ContactEvents, SeeATouchBetweenTwoEndsThatAreFree) {
  // (t - 1/4)(3/4 - t) um over a second
  const auto until = ContactEvents::find_first(one(-0.1875e-6, 1e-6), one(-0.1875e-6, -1e-6), 1.0);
  ASSERT_TRUE(until);
  EXPECT_NEAR(*until, 0.25, 1e-3);
}

TEST(ContactEvents, TakeTheFirstOfTwoRings) {
  const std::vector<Penetration> start{{-1e-6, 1.0}, {-2e-6, 1.0}};
  const std::vector<Penetration> end{{9e-6, 1.0}, {8e-6, 1.0}};
  const auto until = ContactEvents::find_first(start, end, 1e-5);
  ASSERT_TRUE(until);
  EXPECT_NEAR(*until, 1e-6, 1e-9);
}

TEST(ContactEvents, LeaveAStepAloneThatEndsOnTheEventOrHasNone) {
  EXPECT_FALSE(ContactEvents::find_first(one(-1e-6, 1.0), one(0.5e-10, 1.0), 1e-6));
  EXPECT_FALSE(ContactEvents::find_first(one(-2e-6, 0.1), one(-1e-6, 0.1), 1e-5));
  EXPECT_FALSE(ContactEvents::find_first(one(2e-6, 0.1), one(3e-6, 0.1), 1e-5));
}

}  // namespace
}  // namespace engine
