// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_json.h"

#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "jobs/fits/fit_problem.h"
#include "jobs/fits/fit_summary.h"
#include "jobs/fits/intervals.h"
#include "jobs/fits/profile_likelihood.h"
#include "jobs/store/rows.h"
#include "tests/jobs/fits/fit_support.h"

namespace jobs_tests {
namespace {

using jobs::ProfileVerdict;
using nlohmann::json;

/// `identified` of a parameter that the linearised model tells, whose profile has these ends.
json identified_with(ProfileVerdict low, ProfileVerdict high) {
  const std::vector<jobs::Span> spans{{0.1, 0.5, false}};
  const std::vector<double> noise = make_noise(20, 0.0, 1);
  const Eigen::VectorXd residuals = Eigen::Map<const Eigen::VectorXd>(noise.data(), 20);
  jobs::FitProblem problem;
  problem.parameters.push_back({.path = "clearance_mm", .span = spans[0]});
  jobs::FitSummary summary;
  summary.intervals = jobs::calc_intervals(Eigen::MatrixXd::Constant(20, 1, 100.0), residuals, spans,
                                           std::vector<double>{0.3},
                                           {.noise = jobs::ResidualNoise::kWhite, .blocks = {}});
  summary.profiles.emplace(1);
  summary.profiles->front().low.verdict = low;
  summary.profiles->front().high.verdict = high;
  jobs::StudyRow row;
  row.request = R"({"over": {"clearance_mm": {}}, "measurements": []})";
  const json fit = jobs::fit_json(row, problem, summary, jobs::SweepResults{}, 1);
  return fit.at("parameters").at(0).at("identified");
}

TEST(FitJson, CallsAParameterIdentifiedByAnEndThatWasFound) {
  EXPECT_EQ(identified_with(ProfileVerdict::kFound, ProfileVerdict::kLost), true);
  EXPECT_EQ(identified_with(ProfileVerdict::kOpen, ProfileVerdict::kFound), true);
  EXPECT_EQ(identified_with(ProfileVerdict::kOpen, ProfileVerdict::kOpen), false);
  EXPECT_EQ(identified_with(ProfileVerdict::kLost, ProfileVerdict::kOpen), json());
  EXPECT_EQ(identified_with(ProfileVerdict::kLost, ProfileVerdict::kLost), json());
}

}  // namespace
}  // namespace jobs_tests
