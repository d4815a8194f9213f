// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/least_squares.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/errors.h"
#include "tests/jobs/fits/fit_support.h"

namespace jobs_tests {
namespace {

TEST(LeastSquares, FindsRosenbrocksMinimumWithoutALogLine) {
  auto problem = rosenbrock_problem();
  problem.options.differences = jobs::Differences::kCentral;
  LeastSquares fit(problem);
  testing::internal::CaptureStderr();
  const auto result = run_asker(fit, rosenbrock);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(result.end, jobs::FitEnd::kConverged) << result.message;
  EXPECT_NEAR(result.x[0], 1.0, 1e-5);
  EXPECT_NEAR(result.x[1], 1.0, 1e-5);
  // By parts of ranges of length 6.
  EXPECT_NEAR(result.jacobian(0, 1), 60.0, 1e-6);
  EXPECT_NEAR(result.jacobian(1, 0), -6.0, 1e-6);
}

TEST(LeastSquares, GivesTheSameAnswersInReplay) {
  std::map<jobs::FitPoint, std::vector<double>> told;
  LeastSquares fit(rosenbrock_problem());
  const auto result = run_asker(fit, rosenbrock, &told);
  EXPECT_EQ(told.size(), result.evaluations);
  LeastSquares again(rosenbrock_problem());
  for (auto at = told.rbegin(); at != told.rend(); ++at) again.tell(at->first, at->second);
  const auto replayed = again.ask().result;
  ASSERT_TRUE(replayed);
  EXPECT_EQ(replayed->x, result.x);
  EXPECT_EQ(replayed->sum, result.sum);
  EXPECT_EQ(replayed->jacobian, result.jacobian);
  EXPECT_EQ(replayed->evaluations, result.evaluations);
}

// A crash after any evaluation: nothing is asked that the whole fit did not ask.
TEST(LeastSquares, GoesOnFromWhatHasBeenTold) {
  std::map<jobs::FitPoint, std::vector<double>> all;
  LeastSquares fit(rosenbrock_problem());
  const auto result = run_asker(fit, rosenbrock, &all);
  for (const std::size_t kept : {1U, 7U, 20U}) {
    LeastSquares resumed(rosenbrock_problem());
    std::map<jobs::FitPoint, std::vector<double>> told;
    for (const auto& [point, residuals] : all) {
      if (told.size() == kept) break;
      resumed.tell(point, residuals);
      told.emplace(point, residuals);
    }
    EXPECT_EQ(run_asker(resumed, rosenbrock, &told).x, result.x);
    for (const auto& [point, residuals] : told) EXPECT_TRUE(all.contains(point)) << "another point";
  }
}

TEST(LeastSquares, EndsAtAnActiveBound) {
  auto problem = rosenbrock_problem();
  problem.spans[0].to = 0.5;
  LeastSquares fit(problem);
  const auto result = run_asker(fit, rosenbrock);
  EXPECT_EQ(result.end, jobs::FitEnd::kConverged) << result.message;
  EXPECT_EQ(result.x[0], 0.5);
  EXPECT_NEAR(result.x[1], 0.25, 1e-5);  // x1 = x0^2 on the bound
}

TEST(LeastSquares, StepsAroundAFailingRegion) {
  std::size_t failed = 0;
  const Residuals partly = [&](const jobs::FitPoint& x) {
    if (x[0] > -0.5 && x[0] < 0.5 && x[1] < -0.2) return ++failed, std::vector<double>{};
    return rosenbrock(x);
  };
  LeastSquares fit(rosenbrock_problem());
  const auto result = run_asker(fit, partly);
  EXPECT_NEAR(result.x[0], 1.0, 1e-3) << result.message << failed;
}

TEST(LeastSquares, SaysThatItEndedBesideFailures) {
  std::size_t failed = 0;
  const Residuals partly = [&](const jobs::FitPoint& x) {
    return x[0] > 0.3 ? (++failed, std::vector<double>{}) : std::vector<double>{x[0] - 0.6, x[1] - 0.5};
  };
  LeastSquares fit(
      {.spans = {{0.0, 1.0, false}, {0.0, 1.0, false}}, .start = {0.1, 0.1}, .fixed = {}, .options = {}});
  const auto result = run_asker(fit, partly);
  EXPECT_EQ(result.end, jobs::FitEnd::kBesideFailures) << result.message;
  EXPECT_GT(failed, 2U);
  EXPECT_GT(result.x[0], 0.2);
}

TEST(LeastSquares, SaysThatItsStartFailed) {
  LeastSquares fit(rosenbrock_problem());
  const auto result = run_asker(fit, [](const jobs::FitPoint&) { return std::vector<double>{}; });
  EXPECT_EQ(result.end, jobs::FitEnd::kStartFailed);
  EXPECT_FALSE(result.message.empty());
}

TEST(LeastSquares, NamesTheParameterBesideWhichAllFails) {
  auto problem = rosenbrock_problem();
  problem.names = {"clearance_mm", "restitution"};
  LeastSquares fit(problem);
  const auto result = run_asker(fit, [&](const jobs::FitPoint& x) {
    return x[1] == problem.start[1] ? rosenbrock(x) : std::vector<double>{};
  });
  EXPECT_EQ(result.end, jobs::FitEnd::kStartFailed);
  EXPECT_NE(result.message.find("both sides of restitution"), std::string::npos) << result.message;
}

TEST(LeastSquares, KeepsToItsLargestNumberOfEvaluations) {
  auto problem = rosenbrock_problem();
  problem.options.max_evaluations = 12;
  LeastSquares fit(problem);
  const auto result = run_asker(fit, rosenbrock);
  EXPECT_EQ(result.end, jobs::FitEnd::kMostEvaluations);
  EXPECT_LE(result.evaluations, 12U + 2U);
}

TEST(LeastSquares, FitsOnALogarithmicScaleBesideAFixedParameter) {
  LeastSquares fit(
      {.spans = {{1e-3, 1e3, true}, {0.0, 2.0, false}}, .start = {1.0, 0.7}, .fixed = {1}, .options = {}});
  const auto result = run_asker(fit, [](const jobs::FitPoint& x) {
    return std::vector<double>{std::log(x[0] / 40.0), x[1] - 1.0};
  });
  EXPECT_NEAR(result.x[0], 40.0, 1e-3);
  EXPECT_EQ(result.x[1], 0.7);
  EXPECT_TRUE(result.jacobian.col(1).isZero());
}

TEST(LeastSquares, RefusesAStartBeyondItsBounds) {
  auto problem = rosenbrock_problem();
  problem.start[1] = 4.0;
  EXPECT_THROW(static_cast<void>(LeastSquares(problem).ask()), engine::InvalidInput);
}

}  // namespace
}  // namespace jobs_tests
