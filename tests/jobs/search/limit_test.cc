// SPDX-License-Identifier: Apache-2.0
#include "jobs/search/limit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace jobs_tests {
namespace {

using jobs::Evaluation;
using jobs::Limit;
using jobs::LimitRule;
using jobs::SearchInterval;
using jobs::Verdict;

struct Found {
  Limit limit;
  std::size_t evaluations = 0;
};

/// Evaluates what the search asks for until it has ended.
Found search(const SearchInterval& path, const LimitRule& rule,
             const std::function<std::vector<double>(double)>& metric) {
  std::vector<Evaluation> known;
  for (int round = 0; round < 1000; ++round) {
    const Limit limit = find_limit(path, rule, known);
    if (limit.verdict != Verdict::kOpen) return {limit, known.size()};
    EXPECT_FALSE(limit.next.empty());
    for (const double x : limit.next) known.push_back({.x = x, .values = metric(x)});
  }
  ADD_FAILURE() << "the search does not end";
  return {};
}

std::vector<double> itself(double x) { return {x}; }

// Five values in steps of 2.5, of which one step is halved until it is no longer than 0.01: 2.5 / 2^8 =
// 0.0098.
TEST(FindLimit, FindsTheLimitOfAMonotoneMetricWithTheExpectedNumberOfEvaluations) {
  const SearchInterval path{.from = 0.0, .to = 10.0, .tolerance = 0.01, .first = 5};
  for (const double bound : {0.001, 1.234, 3.7, 6.18, 9.99}) {
    const Found found = search(path, {.bound = bound}, itself);
    EXPECT_EQ(found.limit.verdict, Verdict::kFound);
    EXPECT_LE(found.limit.within.value(), bound);
    EXPECT_GT(found.limit.beyond.value(), bound);
    EXPECT_LE(found.limit.beyond.value() - found.limit.within.value(), 0.01);
    EXPECT_EQ(found.evaluations, 5U + 8U);
    EXPECT_EQ(found.evaluations, jobs::most_evaluations(path));
    EXPECT_TRUE(found.limit.falls.empty());
  }
}

// Between 1e-310 and 1e300 no ratio is a double: nothing says where their middle is.
TEST(FindLimit, EndsWhereNothingLiesBetween) {
  EXPECT_EQ(jobs::most_evaluations(
                {.from = 1e-310, .to = 1e300, .logarithmic = true, .tolerance = 1.0, .first = 2}),
            2U);
  EXPECT_EQ(jobs::most_evaluations({.from = 1.0,
                                    .to = std::nextafter(1.0, 2.0),
                                    .logarithmic = true,
                                    .tolerance = 1e-300,
                                    .first = 2}),
            2U);
}

TEST(FindLimit, GoesTheOtherWayIfThePathDoes) {
  const Found found = search({.from = 8.0, .to = 2.0, .tolerance = 0.1, .first = 3}, {.bound = -4.2},
                             [](double x) { return std::vector{-x}; });
  EXPECT_EQ(found.limit.verdict, Verdict::kFound);
  EXPECT_GE(found.limit.within.value(), 4.2);
  EXPECT_LT(found.limit.beyond.value(), 4.2);
}

TEST(FindLimit, StopsAtTheSameRatioEverywhere) {
  const SearchInterval path{.from = 0.01, .to = 10.0, .logarithmic = true, .tolerance = 0.01 * std::log(1000.0), .in_ratios = true, .first = 5};
  for (const double bound : {0.02, 0.3, 8.0}) {
    const Found found = search(path, {.bound = bound}, itself);
    EXPECT_EQ(found.limit.verdict, Verdict::kFound);
    const double ratio = found.limit.beyond.value() / found.limit.within.value();
    EXPECT_LE(ratio, std::pow(1000.0, 0.01) * (1.0 + 1e-9)) << bound;
    EXPECT_GT(ratio, std::pow(1000.0, 0.004)) << bound;
  }
}

TEST(FindLimit, HalvesRatiosOfALogarithmicPath) {
  const SearchInterval path{.from = 1e-3, .to = 1e3, .logarithmic = true, .tolerance = 1e-3, .first = 3};
  EXPECT_EQ(first_values(path), (std::vector{1e-3, 1.0, 1e3}));
  const Found found = search(path, {.bound = 0.05}, itself);
  EXPECT_LE(found.limit.within.value(), 0.05);
  EXPECT_GT(found.limit.beyond.value(), 0.05);
  // The bracket is halved in its logarithm: 1.5e4 of a ratio needs fewer steps down here than
  // most_evaluations() allows for.
  EXPECT_LE(found.evaluations, jobs::most_evaluations(path));
}

// 0 to 0.6 by 0.1, then halves: 0.25, 0.225, 0.2125.
TEST(FindLimit, TriesRoundNumbers) {
  const SearchInterval path{.from = 0.0, .to = 0.6, .tolerance = 0.0125, .first = 7};
  EXPECT_EQ(first_values(path), (std::vector{0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}));
  std::set<double> tried;
  (void)search(path, {.bound = 0.21}, [&](double x) { return tried.insert(x), std::vector{x}; });
  EXPECT_EQ(tried, (std::set{0.0, 0.1, 0.2, 0.2125, 0.225, 0.25, 0.3, 0.4, 0.5, 0.6}));
}

// Versions before the rounding tried 0.09999999999999999 and 0.30000000000000004; their searches have ended.
TEST(FindLimit, TakesFirstValuesThatWereNotRounded) {
  const SearchInterval path{.from = 0.0, .to = 0.6, .tolerance = 0.2, .first = 7};
  std::vector<Evaluation> known;
  for (const double x : first_values(path)) known.push_back({.x = std::nextafter(x, 0.35), .values = {x}});
  EXPECT_EQ(find_limit(path, {.bound = 0.35}, known).verdict, Verdict::kFound);
}

struct EffortCase {
  const char* name;
  SearchInterval path;
};
void PrintTo(const EffortCase& c, std::ostream* out) { *out << c.name; }

class Effort : public testing::TestWithParam<EffortCase> {};

// The most is never exceeded wherever the limit lies. Where the steps are equal it is at most three evaluations above what is
// needed: close to the doubles a middle may lie off by an eighth of the bracket.
TEST_P(Effort, IsAtMostWhatWasAnnounced) {
  const SearchInterval& path = GetParam().path;
  const std::size_t most = jobs::most_evaluations(path);
  std::size_t largest = 0;
  for (int k = 0; k <= 400; ++k) {
    // Limits at both ends lie closer and closer to them.
    const double part = k < 200 ? std::exp2(-0.3 * (200 - k)) / 2.0 : 1.0 - std::exp2(-0.3 * (k - 200)) / 2.0;
    const double bound = std::lerp(path.from, path.to, part);
    const double sign = path.from < path.to ? 1.0 : -1.0;
    const Found found = search(path, {.bound = sign * bound}, [&](double x) { return std::vector{sign * x}; });
    ASSERT_LE(found.evaluations, most) << bound;
    largest = std::max(largest, found.evaluations);
  }
  if (!path.logarithmic) {
    EXPECT_GE(largest + 3, most);
  }
}

INSTANTIATE_TEST_SUITE_P(
    , Effort,
    testing::Values(EffortCase{"below_the_doubles", {.from = 0.02, .to = 0.5, .tolerance = 1e-17, .first = 5}},
                    EffortCase{"of_the_doubles", {.from = 0.02, .to = 0.5, .tolerance = 6e-17, .first = 5}},
                    EffortCase{"halves", {.from = 0.02, .to = 0.5, .tolerance = 0.015, .first = 2}},
                    EffortCase{"downwards", {.from = 0.5, .to = 0.02, .tolerance = 1e-17, .first = 2}},
                    EffortCase{"ratios", {.from = 1e-6, .to = 1e3, .logarithmic = true, .tolerance = 1e-15, .first = 3}},
                    EffortCase{"coarse_ratios", {.from = 0.02, .to = 0.5, .logarithmic = true, .tolerance = 0.01, .first = 5}},
                    EffortCase{"around_zero", {.from = -0.3, .to = 0.5, .tolerance = 1e-14, .first = 2}},
                    EffortCase{"integers", {.from = 3, .to = 1000, .integer = true, .tolerance = 1e-3, .first = 4}},
                    EffortCase{"integers_by_ratio", {.from = 3, .to = 1000, .logarithmic = true, .integer = true, .tolerance = 5, .first = 2}}),
    [](const auto& it) { return it.param.name; });

TEST(FindLimit, EndsBetweenNeighbouringIntegers) {
  const Found found =
      search({.from = 1, .to = 64, .integer = true, .tolerance = 1e-9, .first = 2}, {.bound = 23.5}, itself);
  EXPECT_EQ(found.limit.within, 23.0);
  EXPECT_EQ(found.limit.beyond, 24.0);
}

TEST(FindLimit, SaysWhenThereIsNoLimit) {
  const SearchInterval path{.from = 0.0, .to = 1.0, .tolerance = 0.1, .first = 4};
  const Found never = search(path, {.bound = 2.0}, itself);
  EXPECT_EQ(never.limit.verdict, Verdict::kNeverExceeded);
  EXPECT_EQ(never.limit.within, 1.0);
  EXPECT_FALSE(never.limit.beyond.has_value());
  EXPECT_EQ(never.evaluations, 4U);
  const Found always = search(path, {.bound = -1.0}, itself);
  EXPECT_EQ(always.limit.verdict, Verdict::kAlwaysExceeded);
  EXPECT_EQ(always.limit.beyond, 0.0);
}

// Exceeded between 2 and 4 and again from 7 on: the first crossing is the limit.
TEST(FindLimit, TakesTheFirstCrossingAndTellsWhereTheMetricFalls) {
  const auto wave = [](double x) { return std::vector{(x > 2.0 && x < 4.0) || x > 7.0 ? 1.0 : 0.0}; };
  const Found found = search({.from = 0.0, .to = 10.0, .tolerance = 0.05, .first = 11}, {.bound = 0.5}, wave);
  EXPECT_NEAR(found.limit.within.value(), 2.0, 0.05);
  ASSERT_EQ(found.limit.falls.size(), 1U);
  EXPECT_EQ(found.limit.falls[0].from, 3.0);
  EXPECT_EQ(found.limit.falls[0].to, 4.0);
  EXPECT_TRUE(found.limit.falls[0].within_again);
  EXPECT_FALSE(found.limit.band_from || found.limit.band_to) << "one run each has no band";
  const auto twice = [&](double x) { return std::vector{wave(x).front(), wave(x).front()}; };
  EXPECT_NEAR(search({.from = 0.0, .to = 10.0, .tolerance = 0.05, .first = 11}, {.bound = 0.5}, twice)
                  .limit.band_to.value(),
              8.0, 1e-12)
      << "from there on nothing that was tried is within the bound";
}

// Ten replicates x + 0 .. x + 0.9: nine of them are within the bound 5 up to x = 4.2, all of them up to 4.1,
// none from above 5 on.
TEST(FindLimit, JudgesByAQuantileAndGivesTheBandOfTheReplicates) {
  const auto scattered = [](double x) {
    std::vector<double> values;
    for (int k = 9; k >= 0; --k) values.push_back(x + 0.1 * k);
    return values;
  };
  const SearchInterval path{.from = 0.0, .to = 8.0, .tolerance = 0.001, .first = 9};
  const Found found = search(path, {.bound = 5.0, .quantile = 0.9}, scattered);
  EXPECT_NEAR(found.limit.within.value(), 4.2, 0.001);
  EXPECT_LE(found.limit.band_from.value(), 4.1);
  EXPECT_GE(found.limit.band_from.value(), 4.0);
  EXPECT_GT(found.limit.band_to.value(), 5.0);
  EXPECT_LE(found.limit.band_to.value(), 6.0);
  EXPECT_NEAR(search(path, {.bound = 5.0, .quantile = 1.0}, scattered).limit.within.value(), 4.1, 0.001);
  EXPECT_NEAR(search(path, {.bound = 5.0, .quantile = 0.5}, scattered).limit.within.value(), 4.6, 0.001);
}

TEST(FindLimit, WaitsForWhatIsPendingAndStopsAtWhatIsLost) {
  const SearchInterval path{.from = 0.0, .to = 2.0, .tolerance = 0.1, .first = 3};
  const LimitRule rule{.bound = 0.5};
  const std::vector<Evaluation> pending{
      {.x = 0.0, .values = {0.0}}, {.x = 1.0, .pending = 1, .values = {}}, {.x = 2.0, .values = {2.0}}};
  EXPECT_TRUE(find_limit(path, rule, pending).next.empty());
  EXPECT_EQ(find_limit(path, rule, pending).verdict, Verdict::kOpen);
  std::vector<Evaluation> lost = pending;
  lost[1] = {.x = 1.0, .lost = 1, .lost_reason = "step_limit", .values = {}};
  EXPECT_EQ(find_limit(path, rule, lost).verdict, Verdict::kLost);
  EXPECT_EQ(find_limit(path, rule, lost).lost_reason, "step_limit");
  // The first on the way tells its reason.
  std::vector<Evaluation> twice = lost;
  twice.insert(twice.begin(), {.x = 2.0, .lost = 1, .lost_reason = "cancelled", .values = {}});
  EXPECT_EQ(find_limit(path, rule, twice).lost_reason, "step_limit");
  // Beyond the first crossing it is not in the way.
  EXPECT_EQ(find_limit(path, {.bound = -0.5}, lost).verdict, Verdict::kAlwaysExceeded);
  EXPECT_EQ(find_limit(path, {.bound = -0.5}, lost).lost_reason, std::nullopt);
}

TEST(CalcQuantile, IsTheSmallestValueWithThatPartBelowIt) {
  EXPECT_EQ(jobs::calc_quantile({3, 1, 2}, 1.0), 3);
  EXPECT_EQ(jobs::calc_quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(jobs::calc_quantile({3, 1, 2}, 1e-9), 1);
  std::vector<double> ten;
  for (int k = 1; k <= 10; ++k) ten.push_back(k);
  EXPECT_EQ(jobs::calc_quantile(ten, 0.9), 9);
  EXPECT_EQ(jobs::calc_quantile(ten, 0.91), 10);
}

}  // namespace
}  // namespace jobs_tests
