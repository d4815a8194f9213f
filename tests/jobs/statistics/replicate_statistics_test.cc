// SPDX-License-Identifier: Apache-2.0
#include "jobs/statistics/replicate_statistics.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <thread>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "jobs/service.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using jobs::ReplicateStatistics;
using nlohmann::json;

ReplicateStatistics statistics_of(std::vector<double> values) {
  return jobs::calc_replicate_statistics(values);
}

/// By hand: the squared differences from the mean, 5, are 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16 = 32.
TEST(ReplicateStatistics, AreThoseComputedByHand) {
  const auto statistics = statistics_of({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_EQ(statistics.count, 8U);
  EXPECT_EQ(statistics.mean, 5.0);
  EXPECT_DOUBLE_EQ(statistics.spread.value(), std::sqrt(32.0 / 7.0));
  EXPECT_EQ(statistics.min, 2.0);
  EXPECT_EQ(statistics.max, 9.0);
}

TEST(ReplicateStatistics, HaveNoSpreadBelowTwoValues) {
  const auto one = statistics_of({-3.5});
  EXPECT_EQ(one.count, 1U);
  EXPECT_EQ(one.mean, -3.5);
  EXPECT_FALSE(one.spread.has_value());
  EXPECT_EQ(one.min, -3.5);
  EXPECT_EQ(one.max, -3.5);
  const auto none = statistics_of({});
  EXPECT_EQ(none.count, 0U);
  EXPECT_FALSE(none.mean || none.spread || none.min || none.max);
}

// Differences of -6, -3, 3, 6 from the mean: variance 90 / 3. The mean of squares less the square of the
// mean, 1e18 each, would be off by hundreds.
TEST(ReplicateStatistics, KeepASmallSpreadOfLargeValues) {
  const auto statistics = statistics_of({1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16});
  EXPECT_EQ(statistics.mean, 1e9 + 10);
  EXPECT_DOUBLE_EQ(statistics.spread.value(), std::sqrt(30.0));
}

// A converged case. The sum of three times 0.1, over 3, is not 0.1.
TEST(ReplicateStatistics, OfEqualValuesAreExact) {
  const auto statistics = statistics_of({0.1, 0.1, 0.1});
  EXPECT_EQ(statistics.mean, 0.1);
  EXPECT_EQ(statistics.spread, 0.0);
}

RC_GTEST_PROP(ReplicateStatistics, LieWithinTheirBounds, ()) {
  std::vector<double> values;
  for (const int n :
       *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-1'000'000, 1'000'000))))
    values.push_back(n / 7.0);
  const auto statistics = statistics_of(values);
  RC_ASSERT(*statistics.min <= *statistics.mean && *statistics.mean <= *statistics.max);
  if (values.size() < 2) return;
  // Every value lies within the range, so the sum of squares is at most n range^2; 1e-12 for rounding.
  const double n = static_cast<double>(values.size());
  RC_ASSERT(*statistics.spread <=
            (*statistics.max - *statistics.min) * std::sqrt(n / (n - 1.0)) * (1.0 + 1e-12));
  // The two ends alone lie this far apart.
  RC_ASSERT(*statistics.spread * std::sqrt(2.0 * (n - 1.0)) * (1.0 + 1e-12) >=
            *statistics.max - *statistics.min);
}

TEST(StatisticsByRow, BeginASetAtEachUnperturbedRun) {
  const std::vector<jobs::ReplicateValue> rows{{0, 1.0}, {1, 3.0}, {2, {}},  // the third has failed
                                               {0, 1.0}, {1, 3.0}, {2, 8.0},
                                               {0, {}}, {1, {}}, {2, {}},
                                               {0, {}}, {1, 5.0}, {2, {}}};
  const auto by_row = jobs::calc_statistics_by_row(rows);
  ASSERT_EQ(by_row.size(), rows.size());
  const std::vector<std::size_t> counts{2, 2, 2, 3, 3, 3, 0, 0, 0, 1, 1, 1};
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(by_row[i].count, counts[i]) << i;
  EXPECT_EQ(by_row[2].mean, 2.0);  // also in the row that has failed
  EXPECT_EQ(by_row[3].mean, 4.0);
  EXPECT_FALSE(by_row[6].mean.has_value());
  EXPECT_EQ(by_row[9].min, 5.0);
  EXPECT_TRUE(jobs::calc_statistics_by_row({}).empty());
}

constexpr double kNoPeak = std::numeric_limits<double>::quiet_NaN();

/// Stands for the engine: its runs have the peaks of a list, in the order in which they begin; an empty one
/// fails. Those beyond the list go on until they are stopped.
class ScriptedEngine {
 public:
  explicit ScriptedEngine(std::vector<std::optional<double>> peaks) : peaks_(std::move(peaks)) {}

  [[nodiscard]] jobs::ServiceOptions options(const TemporaryStore& store) {
    jobs::ServiceOptions options = options_of(store, 1);  // one after the other
    options.runner = [this](const jobs::JobSpec&, const engine::StopQuery& stop_requested) {
      return run(stop_requested);
    };
    return options;
  }

  /// Returns when a run beyond the list has begun.
  void await_endless_run() {
    ASSERT_EQ(endless_.get_future().wait_for(std::chrono::seconds(300)), std::future_status::ready);
  }

 private:
  engine::RunResult run(const engine::StopQuery& stop_requested) {
    engine::RunResult result;
    const std::size_t i = begun_++;
    if (i >= peaks_.size()) {
      if (i == peaks_.size()) endless_.set_value();
      while (!stop_requested(0.0)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      result.status = engine::RunStatus::kStopped;
    } else if (!peaks_[i]) {
      result.status = engine::RunStatus::kNonFinite;
    } else {
      result.metrics.assign(engine::metric_table().size(), 1.0);
      result.metrics[0] = *peaks_[i];
    }
    return result;
  }

  std::vector<std::optional<double>> peaks_;
  std::atomic<std::size_t> begun_ = 0;
  std::promise<void> endless_;
};

void expect_set(const ReplicateStatistics& set, std::size_t count, double mean, double spread, double min,
                double max) {
  EXPECT_EQ(set.count, count);
  EXPECT_EQ(set.mean, mean);
  EXPECT_DOUBLE_EQ(set.spread.value_or(-1.0), spread);
  EXPECT_EQ(set.min, min);
  EXPECT_EQ(set.max, max);
}

/// The table of a sweep that has to end by itself.
jobs::ResultTable results_of(jobs::Service& service, const char* request) {
  const std::string id = service.submit_sweep(request_of(request)).at("id");
  EXPECT_TRUE(service.wait_for_sweep(id, std::chrono::seconds(300)));
  return service.find_results(id).value();
}

TEST(Service, SumsUpTheReplicatesThatHaveSucceededSoFar) {
  ASSERT_EQ(engine::metric_table()[0].key, jobs::kReplicateMetric);
  const TemporaryStore store;
  ScriptedEngine engine({10.0, 20.0, std::nullopt, 100.0, 104.0});
  jobs::Service service(engine.options(store));
  const std::string id =
      service
          .submit_sweep(request_of(
              R"({"cases": [{"clearance_mm": 0.1}, {"clearance_mm": 0.2}], "replicates": {"count": 3}})"))
          .at("id");
  engine.await_endless_run();
  for (const char* last : {"running", "cancelled"}) {
    const jobs::ResultTable table = service.find_results(id).value();
    std::vector<std::string> states;
    for (const auto& row : table.rows) states.push_back(row.at(1));
    EXPECT_EQ(states,
              (std::vector<std::string>{"succeeded", "succeeded", "failed", "succeeded", "succeeded", last}));
    ASSERT_EQ(table.replicates.size(), 6U);
    for (std::size_t i = 0; i < 3; ++i) expect_set(table.replicates[i], 2, 15.0, std::sqrt(50.0), 10.0, 20.0);
    for (std::size_t i = 3; i < 6; ++i)
      expect_set(table.replicates[i], 2, 102.0, std::sqrt(8.0), 100.0, 104.0);
    (void)service.cancel_sweep(id);
  }
}

TEST(Service, SumsUpReplicatesThatAnotherSweepHasComputed) {
  const TemporaryStore store;
  ScriptedEngine engine({1.0, 3.0, 8.0});
  jobs::Service service(engine.options(store));
  const auto three = results_of(service, R"({"replicates": {"count": 3}})");
  expect_set(three.replicates.at(2), 3, 4.0, std::sqrt(13.0), 1.0, 8.0);
  const auto two = results_of(service, R"({"replicates": {"count": 2}})");
  expect_set(two.replicates.at(1), 2, 2.0, std::sqrt(2.0), 1.0, 3.0);
}

// Two cases that are one set, since 0.25 mm and 1 are defaults: two samples, not one.
TEST(Service, KeepsEqualSetsApart) {
  const TemporaryStore store;
  ScriptedEngine engine({1.0, 3.0, 2.0, 6.0});
  jobs::Service service(engine.options(store));
  const auto table = results_of(
      service,
      R"({"cases": [{"clearance_mm": 0.25}, {"contact_stiffness_scale": 1}], "replicates": {"count": 2},
         "reuse": false})");
  ASSERT_EQ(table.replicates.size(), 4U);
  EXPECT_EQ(table.rows[0].at(3), table.rows[2].at(3));
  for (const auto& set : table.replicates) EXPECT_EQ(set.count, 2U);
}

TEST(Service, CountsNoReplicateWithoutAPeak) {
  const TemporaryStore store;
  ScriptedEngine engine({kNoPeak, kNoPeak});
  jobs::Service service(engine.options(store));
  const auto table = results_of(service, R"({"replicates": {"count": 2}})");
  EXPECT_EQ(table.rows.at(1).at(1), "succeeded");
  ASSERT_EQ(table.replicates.size(), 2U);
  EXPECT_EQ(table.replicates[0].count, 0U);
  EXPECT_FALSE(table.replicates[0].mean.has_value());
}

TEST(Service, HasNothingToSumUpWithoutReplicates) {
  const TemporaryStore store;
  ScriptedEngine engine({1.0, 2.0});
  jobs::Service service(engine.options(store));
  EXPECT_TRUE(results_of(service, "{}").replicates.empty());
  EXPECT_TRUE(results_of(service, R"({"sweep": {"clearance_mm": [0.1]}, "replicates": {"count": 1}})")
                  .replicates.empty());
}

}  // namespace
}  // namespace jobs_tests
