// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "jobs/store/store.h"
#include "tests/jobs/service_support.h"
#include "tests/jobs/store/store_support.h"

namespace jobs_tests {
namespace {

TEST(Store, QueuesAgainWhatADeadProcessLeftRunning) {
  const TemporaryStore temporary;
  std::string sweep;
  jobs::ClaimedJob abandoned;
  {
    jobs::Store store(temporary.file());
    sweep = add_sweep(store, kThreeJobs);
    abandoned = store.queue.claim().value();
    EXPECT_EQ(count_of(store, sweep, jobs::JobState::kRunning), 1);
  }
  jobs::Store store(temporary.file());
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kQueued), 3);
  const jobs::ClaimedJob again = store.queue.claim().value();
  EXPECT_EQ(again.id, abandoned.id);
  EXPECT_EQ(again.attempt, 2);
  // Results that the first attempt still delivers are void; the second counts, once.
  EXPECT_FALSE(store.queue.record(abandoned, successful_run(1.0)));
  EXPECT_TRUE(store.queue.record(again, successful_run(2.0)));
  EXPECT_FALSE(store.queue.record(again, successful_run(3.0)));
  EXPECT_EQ(store.reader.find_job(again.id)->metrics, R"({"peak":2.0})");
  EXPECT_EQ(store.reader.find_job(again.id)->attempts, 2);
}

TEST(Store, RecordsAJobAndClaimsTheNextOrDoesNeither) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string sweep = add_sweep(store, kThreeJobs);
  const jobs::ClaimedJob first = store.queue.claim().value();
  const auto refuse = [](const jobs::ClaimedJob&) { throw std::bad_alloc(); };
  EXPECT_THROW((void)store.queue.record_and_claim(first, successful_run(1.0), {}, refuse), std::bad_alloc);
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kRunning), 1);
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kQueued), 2);
  std::string told;
  const auto second = store.queue.record_and_claim(first, successful_run(1.0), {},
                                                   [&](const jobs::ClaimedJob& job) { told = job.id; });
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(told, second->id);
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kSucceeded), 1);
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kRunning), 1);
  // One that was cancelled meanwhile leaves nothing; the next is claimed as ever.
  EXPECT_EQ(store.queue.cancel_job(second->id).outcome, jobs::CancelOutcome::kDone);
  const auto third = store.queue.record_and_claim(*second, successful_run(2.0), {}, {});
  ASSERT_TRUE(third.has_value());
  EXPECT_FALSE(store.reader.find_job(second->id)->metrics.has_value());
  EXPECT_FALSE(store.queue.record_and_claim(*third, successful_run(3.0), {}, {}).has_value());
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kSucceeded), 2);
}

TEST(Store, KnowsWhatHasBeenComputed) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), successful_run(7.0)));
  const std::string wider = add_sweep(store, kThreeJobs);
  EXPECT_EQ(count_of(store, wider, jobs::JobState::kSucceeded), 1);
  EXPECT_EQ(count_of(store, wider, jobs::JobState::kQueued), 2);
  const auto rows = store.reader.find_results(wider).value().rows;
  EXPECT_EQ(rows[0].metrics, R"({"peak":7.0})");
  EXPECT_TRUE(store.reader.find_job(rows[0].job_id)->reused);
  EXPECT_TRUE(store.reader.find_trajectory(rows[0].job_id).has_value());
  const std::string forced = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}, "reuse": false})");
  EXPECT_EQ(count_of(store, forced, jobs::JobState::kQueued), 1);
}

TEST(Store, ComputesAFailedContentAgain) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string first = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), failed_run()));
  EXPECT_EQ(count_of(store, first, jobs::JobState::kFailed), 1);
  const std::string second = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  EXPECT_EQ(count_of(store, second, jobs::JobState::kQueued), 1);
}

TEST(Store, LetsAJobWaitForTheSameContentElsewhere) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  const std::string second = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5, 10]}})");
  const auto five = store.queue.claim().value();
  const auto ten = store.queue.claim().value();
  EXPECT_NE(five.parameters, ten.parameters);
  EXPECT_FALSE(store.queue.claim().has_value());
  EXPECT_TRUE(store.queue.record(five, successful_run(1.0)));
  EXPECT_EQ(count_of(store, second, jobs::JobState::kSucceeded), 1);
  EXPECT_FALSE(store.queue.claim().has_value());
}

TEST(Store, LetsAWaitingJobRunWhenTheOtherFailed) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  const auto first = store.queue.claim().value();
  EXPECT_FALSE(store.queue.claim().has_value());
  EXPECT_TRUE(store.queue.record(first, failed_run()));
  EXPECT_TRUE(store.queue.claim().has_value());
}

TEST(Store, ServesTheSweepThatWasServedLeastRecently) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [1, 2, 3, 4]}})");
  std::vector<std::string> speeds;
  const auto claim = [&] {
    speeds.push_back(json_of(store.queue.claim().value().parameters).at("crank_velocity_rad_s").dump());
  };
  claim();
  add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [11, 12]}})");
  (void)store.queue.add_job(jobs::plan_job({{"crank_velocity_rad_s", 21}}), kMaxQueuedInStore);
  for (int i = 0; i < 6; ++i) claim();
  EXPECT_EQ(speeds, (std::vector<std::string>{"1.0", "11.0", "21.0", "2.0", "12.0", "3.0", "4.0"}));
}

TEST(Store, RefusesMoreThanMayWaitAndStoresNoneOfThem) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  EXPECT_THROW((void)store.queue.add_sweep(stored_plan_of(kThreeJobs), kThreeJobs, 2), jobs::QueueFull);
  EXPECT_TRUE(store.reader.list_sweeps("", "", 10).empty());
  EXPECT_TRUE(store.reader.list_jobs("", "", 10).empty());
  EXPECT_NO_THROW((void)store.queue.add_sweep(stored_plan_of(kThreeJobs), kThreeJobs, 3));
}

/// Store with many sweeps of one job each. The requests are one text: what differs is made here.
void add_sweeps(jobs::Store& store, int count, std::int64_t priority = 0) {
  jobs::SweepPlan plan = stored_plan_of(R"({"sweep": {"clearance_mm": [0.1]}})");
  plan.priority = priority;
  const jobs::PlannedJob job = plan.jobs.at(0);
  for (int k = 0; k < count; ++k) {
    plan.jobs[0].content_id = job.content_id + std::to_string(k);
    static_cast<void>(store.queue.add_sweep(plan, "{}", 100'000));
  }
}

/// Counts the statements, and the steps of SQLite's virtual machine, of connections that are opened while it
/// lives.
class StatementCount {
 public:
  StatementCount() {
    statements_ = steps_ = 0;
    sqlite3_auto_extension(reinterpret_cast<void (*)()>(&watch));
  }
  ~StatementCount() { sqlite3_cancel_auto_extension(reinterpret_cast<void (*)()>(&watch)); }
  StatementCount(const StatementCount&) = delete;
  StatementCount& operator=(const StatementCount&) = delete;

  template <typename Work>
  long of(const Work& work) const {
    const long before = statements_;
    work();
    return statements_ - before;
  }
  template <typename Work>
  long steps_of(const Work& work) const {
    const long before = steps_;
    work();
    return steps_ - before;
  }

 private:
  static int watch(sqlite3* database, char** /*error*/, const struct sqlite3_api_routines* /*api*/) {
    return sqlite3_trace_v2(
        database, SQLITE_TRACE_PROFILE,
        [](unsigned /*event*/, void* /*context*/, void* statement, void* /*nanoseconds*/) {
          ++statements_;
          steps_ += sqlite3_stmt_status(static_cast<sqlite3_stmt*>(statement), SQLITE_STMTSTATUS_VM_STEP, 1);
          return 0;
        },
        nullptr);
  }

  static inline std::atomic<long> statements_ = 0, steps_ = 0;
};

// A claim keeps the order that it has found, also beside sweeps that come in between. A list looks at each
// sweep, and not at its jobs.
TEST(Store, ClaimsAndListsWithLittleWorkBesideManySweeps) {
  const TemporaryStore temporary;
  const StatementCount count;
  jobs::Store store(temporary.file());
  constexpr int kMany = 2000, kClaims = 40;
  const auto claim = [&] {
    for (int k = 0; k < kClaims; ++k) {
      if (k % 4 == 0) add_sweeps(store, 1);
      ASSERT_TRUE(store.queue.claim().has_value());
    }
  };
  const auto list = [&] { EXPECT_TRUE(store.reader.list_sweeps("failed", "", 100).empty()); };
  add_sweeps(store, kMany);
  const long first = count.steps_of([&] { ASSERT_TRUE(store.queue.claim().has_value()); });  // finds the order
  EXPECT_GT(first, kMany) << "nothing has been counted";
  EXPECT_LT(count.steps_of(claim), kClaims * first / 10);
  EXPECT_LT(count.steps_of(list), 20 * kMany);
}

// Each has the time left, for which all others count.
TEST(Store, ReadsSweepsByAsManyStatementsHoweverManyOthersWait) {
  const TemporaryStore temporary;
  const StatementCount statements;
  jobs::Store store(temporary.file());
  constexpr int kWaiting = 300;
  add_sweeps(store, kWaiting);
  const std::string sweep = store.reader.list_sweeps("", "", 1).at(0).id;
  const auto ask = [&] {
    static_cast<void>(store.reader.find_sweep(sweep));
    EXPECT_EQ(store.reader.list_sweeps("", "", 50).size(), 50U);
  };
  const long beside_some = statements.of(ask);
  add_sweeps(store, 4 * kWaiting);
  const long beside_many = statements.of(ask);
  EXPECT_GT(beside_some, 50) << "nothing has been counted";
  EXPECT_LT(beside_many, beside_some + 3 * 128 + 20) << "the sample has been read anew, at the most";
}

TEST(Store, SamplesManySweepsOfEachPriority) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string first = add_sweep(store, R"({"priority": 7, "sweep": {"clearance_mm": [0.1]}})");
  static_cast<void>(store.queue.claim());  // the one that runs is a stratum of its own
  add_sweeps(store, 500);
  add_sweeps(store, 3, 5);
  const std::string last = add_sweep(store, R"({"sweep": {"clearance_mm": [0.2]}})");
  const jobs::SweepRow row = store.reader.find_sweep(last).value();
  EXPECT_LE(row.rivals.size(), 128U);
  std::map<std::int64_t, double> of_priority;
  for (const auto& rival : row.rivals) of_priority[rival->priority] += rival->weight;
  EXPECT_EQ(of_priority[7], 1.0);
  EXPECT_EQ(of_priority[5], 3.0);
  EXPECT_NEAR(of_priority[0], 500.0, 13.0);  // less one of the sample, if the sweep itself is in it
}

}  // namespace
}  // namespace jobs_tests
