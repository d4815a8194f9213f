// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/intervals.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "jobs/fits/autoregression.h"
#include "jobs/fits/profile_likelihood.h"
#include "jobs/parameters/unit_scale.h"
#include "tests/jobs/fits/fit_support.h"

namespace jobs_tests {
namespace {

const jobs::FitPoint kTrue{1.0, 0.5, 6.0};

jobs::LeastSquaresProblem oscillation_problem() {
  return {.spans = {{0.2, 3.0, false}, {0.05, 5.0, true}, {4.0, 8.0, false}},
          .start = {1.2, 0.6, 6.2},
          .fixed = {},
          .options = {}};
}

/// Parts of 200 realisations.
struct Coverage {
  double region = 0.0;     ///< whose 95 % region of all parameters holds the true values
  double intervals = 0.0;  ///< all of whose intervals do
};

bool is_in_region(const jobs::FitIntervals& intervals, const std::vector<jobs::Span>& spans) {
  Eigen::Vector3d off;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    off[i] = jobs::part_at(spans[k], kTrue[k]) - jobs::part_at(spans[k], intervals.parameters[k].value);
  }
  return off.dot(intervals.covariance.ldlt().solve(off)) <= intervals.quantile * intervals.quantile;
}

Coverage calc_coverage(double correlation, jobs::ResidualNoise noise) {
  const std::vector<jobs::Span> spans = oscillation_problem().spans;
  Coverage coverage;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::vector<double> measured = oscillation(kTrue, 300);
    const auto errors = make_noise(measured.size(), correlation, seed);
    for (std::size_t k = 0; k < measured.size(); ++k) measured[k] += 0.1 * errors[k];
    LeastSquares fit(oscillation_problem());
    const auto result = run_asker(fit, [&](const jobs::FitPoint& x) {
      auto y = oscillation(x, measured.size());
      for (std::size_t k = 0; k < y.size(); ++k) y[k] -= measured[k];
      return y;
    });
    const auto intervals = jobs::calc_intervals(result.jacobian, result.residuals, spans, result.x,
                                                {.noise = noise, .blocks = {}});
    bool are_held = true;
    for (std::size_t i = 0; i < 3; ++i)
      are_held &= intervals.parameters[i].low <= kTrue[i] && kTrue[i] <= intervals.parameters[i].high;
    coverage.intervals += are_held ? 1.0 / 200.0 : 0.0;
    coverage.region += is_in_region(intervals, spans) ? 1.0 / 200.0 : 0.0;
  }
  return coverage;
}

TEST(FitIntervals, HoldTheTrueValuesUnderWhiteNoise) {
  for (const auto noise : {jobs::ResidualNoise::kWhite, jobs::ResidualNoise::kAutocorrelated}) {
    const Coverage coverage = calc_coverage(0.0, noise);
    EXPECT_GE(coverage.region, 0.90);
    EXPECT_LE(coverage.region, 0.99);
    EXPECT_GE(coverage.intervals, 0.95);
  }
}

TEST(FitIntervals, HoldTheTrueValuesUnderCorrelatedNoise) {
  const Coverage coverage = calc_coverage(0.8, jobs::ResidualNoise::kAutocorrelated);
  const Coverage taken_as_white = calc_coverage(0.8, jobs::ResidualNoise::kWhite);
  EXPECT_GE(coverage.region, 0.90);
  EXPECT_LE(coverage.region, 0.99);
  EXPECT_GE(coverage.intervals, 0.95);
  EXPECT_LT(taken_as_white.intervals, 0.85) << "the correlation matters here";
}

/// Part of 400 linear models of twelve features whose 95 % region holds the true values. Half of the
/// features' variance is common to all of them.
double calc_replicate_coverage(bool has_replicates) {
  constexpr Eigen::Index kFeatures = 12, kRuns = 16;
  const std::vector<jobs::Span> spans(3, jobs::Span{0.0, 1.0, false});
  const std::vector<double> best{0.5, 0.5, 0.5};
  double coverage = 0.0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const Eigen::Index count = (kRuns + 1) * (kFeatures + 1) + 3 * kFeatures;
    const auto draws = make_noise(static_cast<std::size_t>(count), 0.0, seed);
    std::size_t next = 0;
    Eigen::MatrixXd runs(kFeatures, kRuns + 1);
    for (auto run : runs.colwise()) {
      const double common = draws[next++];
      for (double& feature : run) feature = std::sqrt(0.5) * (common + draws[next++]);
    }
    Eigen::MatrixXd jacobian(kFeatures, 3);
    for (auto column : jacobian.colwise())
      for (double& slope : column) slope = 20.0 * (1.0 + 0.5 * draws[next++]);
    const Eigen::MatrixXd replicates = runs.leftCols(kRuns);
    const Eigen::VectorXd off = replicates.rowwise().mean() - runs.col(kRuns);  // at the true values
    const Eigen::VectorXd step = jacobian.colPivHouseholderQr().solve(off);
    const auto intervals = jobs::calc_intervals(
        jacobian, off - jacobian * step, spans, best,
        {.noise = jobs::ResidualNoise::kWhite,
         .blocks = {},
         .replicates = has_replicates ? replicates : Eigen::MatrixXd()});
    const double distance = step.dot(intervals.covariance.ldlt().solve(step));
    const bool is_held = distance <= intervals.quantile * intervals.quantile;
    coverage += is_held ? 1.0 / 400.0 : 0.0;
  }
  return coverage;
}

TEST(FitIntervals, HoldTheTrueValuesOfRunsThatScatter) {
  const double coverage = calc_replicate_coverage(true);
  EXPECT_GE(coverage, 0.92);
  EXPECT_LE(coverage, 0.995);
  EXPECT_LT(calc_replicate_coverage(false), 0.85) << "what the features have in common matters here";
}

TEST(Autoregression, FindsTheCorrelationOfItsSeries) {
  const auto model = jobs::fit_autoregression(make_noise(20000, 0.8, 1));
  ASSERT_EQ(model.coefficients.size(), 1U);
  EXPECT_NEAR(model.coefficients[0], 0.8, 0.02);                  // 4 deviations: sqrt((1 - 0.64) / 20000)
  EXPECT_NEAR(jobs::calc_autocorrelation_time(model), 9.0, 1.2);  // (1 + 0.8) / (1 - 0.8)
}

TEST(Autoregression, FindsBothCoefficientsOfOrderTwo) {
  const auto innovations = make_noise(20000, 0.0, 7);
  std::vector<double> series{0.0, 0.0};
  for (const double e : innovations)
    series.push_back(1.2 * series.back() - 0.6 * series[series.size() - 2] + e);
  const auto model = jobs::fit_autoregression(series);
  ASSERT_EQ(model.coefficients.size(), 2U);
  EXPECT_NEAR(model.coefficients[0], 1.2, 0.025);  // 4 deviations: sqrt((1 - 0.36) / 20000)
  EXPECT_NEAR(model.coefficients[1], -0.6, 0.025);
  EXPECT_NEAR(model.innovation, 1.0, 0.05);
}

// Line through equidistant points: var(slope) = s^2 / sum (t - mean)^2.
TEST(FitIntervals, MatchTheClosedFormOfALine) {
  Eigen::MatrixXd jacobian(50, 2);
  Eigen::VectorXd residuals(50);
  const auto noise = make_noise(50, 0.0, 3);
  double squares = 0.0;
  for (Eigen::Index k = 0; k < 50; ++k) {
    const double t = static_cast<double>(k) - 24.5;
    jacobian.row(k) << 10.0, 10.0 * t;
    squares += t * t;
    residuals[k] = 0.1 * noise[static_cast<std::size_t>(k)];
  }
  const std::vector<jobs::Span> spans{{0.0, 10.0, false}, {0.0, 10.0, false}};
  const auto intervals = jobs::calc_intervals(jacobian, residuals, spans, std::vector<double>{5.0, 5.0},
                                              {.noise = jobs::ResidualNoise::kWhite, .blocks = {}});
  const double s = std::sqrt(residuals.squaredNorm() / 48.0);
  EXPECT_NEAR(intervals.quantile, std::sqrt(2.0 * 3.1907), 1e-4);  // table of F, 2 and 48 degrees of freedom
  EXPECT_NEAR(intervals.parameters[1].high - 5.0, intervals.quantile * s / std::sqrt(squares), 1e-5);
  EXPECT_NEAR(intervals.correlation(0, 1), 0.0, 1e-12);
}

TEST(FitIntervals, NameParametersThatCannotBeTold) {
  Eigen::MatrixXd jacobian(40, 4);
  Eigen::VectorXd residuals(40);
  const auto noise = make_noise(40, 0.0, 5);
  for (Eigen::Index k = 0; k < 40; ++k) {
    const double t = 0.1 * static_cast<double>(k);
    jacobian.row(k) << std::sin(t), std::sin(t), 0.0,
        t;  // a product a b, an idle parameter, one that is told
    residuals[k] = 1e-3 * noise[static_cast<std::size_t>(k)];
  }
  const std::vector<jobs::Span> spans(4, {0.5, 2.0, true});
  const auto intervals = jobs::calc_intervals(jacobian, residuals, spans, std::vector<double>(4, 1.0), {});
  const std::vector<std::string> names{"restitution", "viscous_damping", "clearance_mm", "mass"};
  const auto sentences = jobs::describe_unidentifiable(names, intervals);
  ASSERT_EQ(sentences.size(), 2U);
  const std::string all = sentences[0] + sentences[1];
  EXPECT_NE(all.find("cannot be told from"), std::string::npos) << all;
  EXPECT_NE(all.find("clearance_mm has no influence"), std::string::npos) << all;
  EXPECT_EQ(all.find("mass"), std::string::npos) << all;
  EXPECT_TRUE(std::isfinite(intervals.deviations[3]));
  EXPECT_TRUE(std::isinf(intervals.deviations[0]));
  EXPECT_EQ(intervals.parameters[0].low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(intervals.parameters[0].high, std::numeric_limits<double>::infinity());
}

/// Fit, intervals and profile of a model with white noise.
struct Profiled {
  jobs::FitIntervals intervals;
  std::vector<jobs::ProfileInterval> ends;
};

Profiled profile(const jobs::LeastSquaresProblem& problem, const Residuals& residuals) {
  LeastSquares fit(problem);
  jobs::ProfileProblem wanted{
      .spans = problem.spans, .best = run_asker(fit, residuals), .intervals = {}, .refit = {}};
  wanted.intervals =
      jobs::calc_intervals(wanted.best.jacobian, wanted.best.residuals, problem.spans, wanted.best.x,
                           {.noise = jobs::ResidualNoise::kWhite, .blocks = {}});
  ProfileLikelihood asker(wanted);
  return {wanted.intervals, run_asker(asker, residuals)};
}

TEST(ProfileLikelihood, IsTheLinearisedIntervalOfALinearModel) {
  const auto noise = make_noise(60, 0.0, 2);
  const auto line = [&](const jobs::FitPoint& x) {
    std::vector<double> r;
    for (std::size_t k = 0; k < noise.size(); ++k)
      r.push_back(x[0] + x[1] * 0.1 * static_cast<double>(k) - 3.0 - 0.2 * static_cast<double>(k) -
                  0.3 * noise[k]);
    return r;
  };
  const auto [intervals, ends] = profile(
      {.spans = {{0.0, 6.0, false}, {0.0, 4.0, false}}, .start = {1.0, 1.0}, .fixed = {}, .options = {}},
      line);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& linear = intervals.parameters[i];
    const double tolerance = 0.03 * (linear.high - linear.low);  // 2 % of the root's threshold
    EXPECT_NEAR(ends[i].low.value, linear.low, tolerance);
    EXPECT_NEAR(ends[i].high.value, linear.high, tolerance);
    EXPECT_EQ(ends[i].high.verdict, jobs::ProfileVerdict::kFound);
  }
}

// r = exp(x) + noise: the excess of the sum is n (exp(x) - exp(best))^2, whose ends are known.
TEST(ProfileLikelihood, IsAsymmetricForANonlinearModel) {
  auto noise = make_noise(40, 0.0, 2);
  const double mean = std::accumulate(noise.begin(), noise.end(), 0.0) / 40.0;
  const auto [intervals, ends] =
      profile({.spans = {{-6.0, 4.0, false}}, .start = {0.5}, .fixed = {}, .options = {}},
              [&](const jobs::FitPoint& x) {
                std::vector<double> r;
                for (const double e : noise) r.push_back(std::exp(x[0]) - 1.0 - 2.0 * (e - mean));
                return r;
              });
  const double reach = intervals.quantile * intervals.residual_deviation / std::sqrt(40.0);
  EXPECT_NEAR(ends[0].low.value, std::log(1.0 - reach), 0.05);
  EXPECT_NEAR(ends[0].high.value, std::log(1.0 + reach), 0.02);
  EXPECT_GT(-ends[0].low.value, 1.5 * ends[0].high.value);
}

// An end within the tolerance of the search, but beyond the span.
TEST(ProfileLikelihood, HasNoEndBeyondTheSpan) {
  const auto noise = make_noise(30, 0.0, 4);
  const auto at_most = [&](double to) {
    return profile({.spans = {{0.0, to, false}}, .start = {4.0}, .fixed = {}, .options = {}}, [&](const jobs::FitPoint& x) {
             std::vector<double> r;
             for (const double e : noise) r.push_back(x[0] - 5.0 - 0.1 * e);
             return r;
           }).ends[0];
  };
  const double end = at_most(10.0).high.value;
  const double centre = 0.5 * (end + at_most(10.0).low.value);
  for (const double part : {0.5, 0.9, 0.985, 0.995}) {
    const double to = centre + part * (end - centre);
    EXPECT_EQ(at_most(to).high.verdict, jobs::ProfileVerdict::kOpen) << part;
    EXPECT_LE(at_most(to).high.value, to) << part;
  }
}

TEST(ProfileLikelihood, IsOpenWhereTheBoundIsReached) {
  const auto noise = make_noise(30, 0.0, 4);
  const auto [intervals, ends] = profile(
      {.spans = {{0.0, 1.0, false}, {0.0, 10.0, false}}, .start = {0.5, 4.0}, .fixed = {}, .options = {}},
      [&](const jobs::FitPoint& x) {
        std::vector<double> r;
        for (const double e : noise) r.push_back(1e-6 * x[0] + x[1] - 5.0 - 0.1 * e);
        return r;
      });
  EXPECT_EQ(ends[0].low.verdict, jobs::ProfileVerdict::kOpen);
  EXPECT_EQ(ends[0].high.value, 1.0);
  EXPECT_NE(ends[0].high.message.find("open"), std::string::npos);
  EXPECT_EQ(ends[1].high.verdict, jobs::ProfileVerdict::kFound);
}

}  // namespace
}  // namespace jobs_tests
