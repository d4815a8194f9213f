// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <atomic>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "jobs/results/resource_json.h"
#include "jobs/store/store.h"
#include "tests/jobs/service_support.h"
#include "tests/jobs/store/store_support.h"

namespace jobs_tests {
namespace {

jobs::RunRecord success(double metric) {
  jobs::RunRecord record;
  record.metrics = {{"peak", metric}};
  record.trajectory.channels = {{.key = "t_s", .help = ""}};
  record.trajectory.columns = {{0.0, metric}};
  record.wall_time_s = 2.0;
  return record;
}

jobs::RunRecord failure() {
  jobs::RunRecord record;
  record.end = jobs::RunRecord::End::kFailed;
  record.error_reason = "non_finite";
  record.error_detail = "no number";
  record.error_t_s = 0.5;
  return record;
}

std::int64_t count_of(const jobs::Store& store, const std::string& sweep, jobs::JobState state) {
  return store.reader.find_sweep(sweep).value().counts[static_cast<std::size_t>(state)];
}

constexpr const char* kThreeJobs = R"({"sweep": {"crank_velocity_rad_s": [5, 10, 12]}})";

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
  // What the first attempt still delivers is void; the second counts, once.
  EXPECT_FALSE(store.queue.record(abandoned, success(1.0)));
  EXPECT_TRUE(store.queue.record(again, success(2.0)));
  EXPECT_FALSE(store.queue.record(again, success(3.0)));
  EXPECT_EQ(store.reader.find_job(again.id)->metrics, R"({"peak":2.0})");
  EXPECT_EQ(store.reader.find_job(again.id)->attempts, 2);
}

TEST(Store, RecordsAJobAndClaimsTheNextOrDoesNeither) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string sweep = add_sweep(store, kThreeJobs);
  const jobs::ClaimedJob first = store.queue.claim().value();
  const auto refuse = [](const jobs::ClaimedJob&) { throw std::bad_alloc(); };
  EXPECT_THROW((void)store.queue.record_and_claim(first, success(1.0), {}, refuse), std::bad_alloc);
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kRunning), 1);
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kQueued), 2);
  std::string told;
  const auto second = store.queue.record_and_claim(first, success(1.0), {},
                                                   [&](const jobs::ClaimedJob& job) { told = job.id; });
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(told, second->id);
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kSucceeded), 1);
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kRunning), 1);
  // One that was cancelled meanwhile leaves nothing; the next is claimed as ever.
  EXPECT_EQ(store.queue.cancel_job(second->id).outcome, jobs::CancelOutcome::kDone);
  const auto third = store.queue.record_and_claim(*second, success(2.0), {}, {});
  ASSERT_TRUE(third.has_value());
  EXPECT_FALSE(store.reader.find_job(second->id)->metrics.has_value());
  EXPECT_FALSE(store.queue.record_and_claim(*third, success(3.0), {}, {}).has_value());
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kSucceeded), 2);
}

TEST(Store, KnowsWhatHasBeenComputed) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), success(7.0)));
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
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), failure()));
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
  EXPECT_TRUE(store.queue.record(five, success(1.0)));
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
  EXPECT_TRUE(store.queue.record(first, failure()));
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
  for (const jobs::RivalSweep& rival : row.rivals) of_priority[rival.priority] += rival.weight;
  EXPECT_EQ(of_priority[7], 1.0);
  EXPECT_EQ(of_priority[5], 3.0);
  EXPECT_NEAR(of_priority[0], 500.0, 13.0);  // less one of the sample, if the sweep itself is in it
}

TEST(Store, ListsByStateTheSweepsWhoseJobsAreInIt) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  // Every combination of states of four jobs, set beside the store's own ways.
  constexpr std::array<const char*, 5> kStates{"queued", "running", "succeeded", "failed", "cancelled"};
  for (int k = 0; k < 5 * 5 * 5; ++k)
    add_sweep(store, R"({"sweep": {"clearance_mm": [0.1, 0.2, 0.3]}, "reuse": false})");
  {
    SQLite::Database other(temporary.file().string(), SQLite::OPEN_READWRITE);
    SQLite::Statement set(other, "UPDATE jobs SET state = ? WHERE seq = ?");
    for (int k = 0; k < 5 * 5 * 5; ++k) {
      for (int j = 0, digits = k; j < 3; ++j, digits /= 5) {
        set.reset();
        set.bind(1, kStates[static_cast<std::size_t>(digits % 5)]);
        set.bind(2, 3 * k + j + 1);
        set.exec();
      }
    }
  }
  const auto all = store.reader.list_sweeps("", "", 1000);
  ASSERT_EQ(all.size(), 125U);
  std::size_t listed = 0;
  for (const char* const state : kStates) {
    std::vector<std::string> expected;
    for (const jobs::SweepRow& row : all)
      if (jobs::sweep_state(row.counts) == state) expected.push_back(row.id);
    std::vector<std::string> found;
    for (const jobs::SweepRow& row : store.reader.list_sweeps(state, "", 1000)) found.push_back(row.id);
    EXPECT_EQ(found, expected) << state;
    listed += found.size();
  }
  EXPECT_EQ(listed, 125U);
}

TEST(Store, DropsTheResultOfACancelledJob) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  add_sweep(store, kThreeJobs);
  const auto job = store.queue.claim().value();
  const auto cancellation = store.queue.cancel_job(job.id);
  EXPECT_EQ(cancellation.outcome, jobs::CancelOutcome::kDone);
  ASSERT_EQ(cancellation.running.size(), 1U);
  EXPECT_EQ(cancellation.running[0].id, job.id);
  EXPECT_EQ(cancellation.running[0].attempt, job.attempt);
  EXPECT_FALSE(store.queue.record(job, success(1.0)));
  store.queue.requeue(job);
  EXPECT_EQ(store.reader.find_job(job.id)->state, "cancelled");
  EXPECT_EQ(store.queue.cancel_job(job.id).outcome, jobs::CancelOutcome::kDone);
  EXPECT_EQ(store.queue.cancel_job("job_none").outcome, jobs::CancelOutcome::kMissing);
}

TEST(Store, DeletesAJobOfNoSweepButNotWhatAnotherShares) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const jobs::PlannedJob plan = jobs::plan_job({{"crank_velocity_rad_s", 5}});
  const std::string first = store.queue.add_job(plan, 10);
  EXPECT_EQ(store.queue.delete_job(first), jobs::DeleteOutcome::kNotEnded);
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), success(5.0)));
  const std::string second = store.queue.add_job(plan, 10);
  EXPECT_EQ(store.reader.find_job(second)->state, "succeeded") << "the result is shared";
  EXPECT_EQ(store.queue.delete_job(first), jobs::DeleteOutcome::kDone);
  EXPECT_FALSE(store.reader.find_job(first).has_value());
  EXPECT_TRUE(store.reader.find_trajectory(second).has_value());
  EXPECT_EQ(store.queue.delete_job(second), jobs::DeleteOutcome::kDone);
  EXPECT_EQ(store.queue.delete_job(second), jobs::DeleteOutcome::kMissing);
  const std::string sweep = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  EXPECT_EQ(store.reader.find_sweep(sweep)->counts[0], 1) << "the result is gone with its last job";
  const auto rows = store.reader.find_results(sweep).value().rows;
  EXPECT_EQ(store.queue.delete_job(rows[0].job_id), jobs::DeleteOutcome::kOfSweep);
}

TEST(Store, DeletesASweepButNotWhatAnotherShares) {
  const TemporaryStore temporary;
  {
    jobs::Store store(temporary.file());
    const std::string first = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5, 10]}})");
    EXPECT_EQ(store.queue.delete_sweep(first), jobs::DeleteOutcome::kNotEnded);
    EXPECT_TRUE(store.queue.record(store.queue.claim().value(), success(5.0)));
    EXPECT_TRUE(store.queue.record(store.queue.claim().value(), success(10.0)));
    const std::string second = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
    const auto shared = store.reader.find_results(second).value().rows;
    EXPECT_EQ(store.queue.delete_sweep(first), jobs::DeleteOutcome::kDone);
    EXPECT_EQ(store.queue.delete_sweep(first), jobs::DeleteOutcome::kMissing);
    EXPECT_FALSE(store.reader.find_sweep(first).has_value());
    EXPECT_EQ(store.reader.find_results(second).value().rows[0].metrics, R"({"peak":5.0})");
    EXPECT_TRUE(store.reader.find_trajectory(shared[0].job_id).has_value());
  }
  EXPECT_EQ(
      query_sql(temporary.file(),
                "SELECT (SELECT count(*) FROM results) || ' ' || (SELECT count(*) FROM contents) || ' ' || "
                "(SELECT count(*) FROM trajectories) || ' ' || (SELECT count(*) FROM jobs)"),
      "1 1 1 1");
  EXPECT_EQ(query_sql(temporary.file(), "PRAGMA integrity_check"), "ok");
  EXPECT_EQ(query_sql(temporary.file(), "SELECT count(*) FROM pragma_foreign_key_check"), "0");
}

TEST(Store, GivesTheRoomOfADeletedSweepBack) {
  const TemporaryStore temporary;
  std::uintmax_t full = 0;
  {
    jobs::Store store(temporary.file());
    const std::string sweep =
        add_sweep(store, R"({"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 500}}})");
    ASSERT_EQ(store.queue.cancel_sweep(sweep).outcome, jobs::CancelOutcome::kDone);
  }
  full = std::filesystem::file_size(temporary.file());
  {
    jobs::Store store(temporary.file());
    const std::string sweep = store.reader.list_sweeps("", "", 1).at(0).id;
    EXPECT_EQ(store.queue.delete_sweep(sweep), jobs::DeleteOutcome::kDone);
    store.release_free_pages();
  }
  EXPECT_LT(std::filesystem::file_size(temporary.file()), full / 4);
}

// The queue is made for the version of the engine that computes it, not for the one that queued it.
TEST(Store, RenamesWhatAnOlderEngineWasToCompute) {
  const TemporaryStore temporary;
  std::string sweep;
  {
    jobs::Store store(temporary.file());
    sweep = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  }
  const std::string name = query_sql(temporary.file(), "SELECT content_id FROM contents");
  execute_sql(temporary.file(), "UPDATE contents SET content_id = 'old', engine_version = '0.0.1'");
  { const jobs::Store store(temporary.file()); }
  EXPECT_EQ(
      query_sql(temporary.file(), "SELECT c.content_id FROM jobs j JOIN contents c ON c.seq = j.content"),
      name);
}

TEST(Store, CountsOnlyWhatASweepHasComputedItselfAsItsCost) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), success(1.0)));
  const std::string sweep = add_sweep(
      store, R"({"sweep": {"coupler": ["rigid", "flexible"], "crank_velocity_rad_s": [5, 10, 12]}})");
  auto costs = store.reader.find_sweep(sweep).value().costs;
  EXPECT_EQ(costs.at("rigid, clearance").computed, 0);
  EXPECT_EQ(costs.at("rigid, clearance").queued, 2);
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), success(1.0)));
  (void)store.queue.claim();
  costs = store.reader.find_sweep(sweep).value().costs;
  EXPECT_EQ(costs.at("rigid, clearance").computed, 1);
  EXPECT_EQ(costs.at("rigid, clearance").wall_time_s, 2.0);
  ASSERT_EQ(costs.at("rigid, clearance").running.size(), 1U);
  EXPECT_EQ(costs.at("rigid, clearance").running.at(0).simulated_s, 1.0);
  EXPECT_EQ(costs.at("flexible, clearance").queued, 3);
  EXPECT_EQ(costs.at("flexible, clearance").queued_s, 3.0);
}

TEST(Store, FindsTheSweepsThatShareTheThreads) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string ended =
      add_sweep(store, R"({"parameters": {"duration_s": 4}, "sweep": {"crank_velocity_rad_s": [4]}})");
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), success(1.0)));
  EXPECT_TRUE(store.reader.find_sweep(ended)->rivals.empty());
  const std::string first = add_sweep(store, R"({"priority": 3, "parameters": {"duration_s": 7},
                                                 "sweep": {"crank_velocity_rad_s": [5, 6]}})");
  const std::string second =
      add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [7], "duration_s": [1, 2, 3]}})");
  (void)store.queue.claim();
  for (const jobs::SweepRow& row :
       {store.reader.find_sweep(second).value(), store.reader.list_sweeps("", "", 3).at(0)}) {
    EXPECT_EQ(row.id, second);
    EXPECT_EQ(row.unit_s, 1.0);
    ASSERT_EQ(row.rivals.size(), 1U);
    EXPECT_EQ(row.rivals[0].priority, 3);
    EXPECT_EQ(row.rivals[0].unit_s, 7.0);
    EXPECT_EQ(row.rivals[0].costs.at("rigid, clearance").queued, 1);
    EXPECT_EQ(row.rivals[0].costs.at("rigid, clearance").running.size(), 1U);
    EXPECT_EQ(row.usual_rates.at("rigid, clearance"), 0.5) << "2 s for 4 s of the ended sweep";
  }
  const auto row = store.reader.find_sweep(first).value();
  EXPECT_EQ(row.unit_s, 7.0);
  ASSERT_EQ(row.rivals.size(), 1U);
  EXPECT_EQ(row.rivals[0].costs.at("rigid, clearance").queued_s, 6.0);
}

// A run takes 2 s on the wall here, whatever it simulates.
TEST(Store, CountsTheTimeThatJobsSimulateIfASweepVariesIt) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string sweep = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5], "duration_s": [0.5, 2, 6, 7]}})");
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), success(1.0)));
  (void)store.queue.claim();
  const jobs::CostOfKind cost = store.reader.find_sweep(sweep).value().costs.at("rigid, clearance");
  EXPECT_EQ(cost.computed_s, 0.5);
  EXPECT_EQ(cost.rates, 4.0);
  EXPECT_EQ(cost.rate_squares, 16.0);
  EXPECT_EQ(cost.queued_s, 13.0);
  EXPECT_EQ(cost.queued_squares_s2, 36.0 + 49.0);
  EXPECT_EQ(cost.longest_queued_s, 7.0);
  ASSERT_EQ(cost.running.size(), 1U);
  EXPECT_EQ(cost.running.at(0).simulated_s, 2.0);
  EXPECT_GE(cost.running.at(0).elapsed_s, 0.0);
}

// It may have megabytes, which nobody looks at there.
TEST(Store, LeavesTheRequestOutOfListingsAndChanges) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string sweep = add_sweep(store, kThreeJobs);
  EXPECT_EQ(store.reader.list_sweeps("", "", 1).at(0).request, "");
  EXPECT_EQ(store.reader.find_changes(sweep, 0)->sweep.request, "");
  EXPECT_EQ(store.reader.find_sweep(sweep)->request, kThreeJobs);
  EXPECT_EQ(store.reader.find_results(sweep)->sweep.request, kThreeJobs);
}

TEST(Store, KnowsWhetherASweepHasEnded) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  EXPECT_FALSE(store.reader.has_sweep_ended("sweep_none").has_value());
  const std::string sweep = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5, 6]}})");
  EXPECT_EQ(store.reader.has_sweep_ended(sweep), false);  // all queued
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), success(1.0)));
  EXPECT_EQ(store.reader.has_sweep_ended(sweep), false);  // one queued
  const auto last = store.queue.claim().value();
  EXPECT_EQ(store.reader.has_sweep_ended(sweep), false);  // one running
  const auto jobs = store.reader.find_results(sweep)->rows;
  EXPECT_EQ(store.reader.has_job_ended(jobs[0].job_id), true);
  EXPECT_EQ(store.reader.has_job_ended(jobs[1].job_id), false);
  EXPECT_TRUE(store.queue.record(last, failure()));
  EXPECT_EQ(store.reader.has_job_ended(jobs[1].job_id), true);
  EXPECT_EQ(store.reader.has_sweep_ended(sweep), true);
}

TEST(Store, TellsWhichResultsAreNew) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string sweep = add_sweep(store, kThreeJobs);
  EXPECT_TRUE(store.reader.find_ended(sweep, 0).empty());
  store.queue.record(store.queue.claim().value(), success(1.0));
  const auto first = store.reader.find_ended(sweep, 0);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].swept, "[5.0]");
  EXPECT_EQ(first[0].metrics, R"({"peak":1.0})");
  store.queue.record(store.queue.claim().value(), failure());
  const auto second = store.reader.find_ended(sweep, first[0].change);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].state, "failed");
  EXPECT_TRUE(store.reader.find_ended(sweep, second[0].change).empty());
  // The whole table says the same of each job.
  const auto rows = store.reader.find_results(sweep).value().rows;
  EXPECT_EQ(rows[1].change, second[0].change);
  EXPECT_EQ(rows[2].change, 0);
}

// More cases than calls may stand inside one another, with numbers that only all their digits tell apart.
TEST(Store, AddsCasesToARequestAsTheyAreWritten) {
  constexpr int kExtension = 250;
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const char* const request = R"({"name":"é","cases":[{"clearance_mm":0.1}]})";
  const std::string sweep = add_sweep(store, request);
  auto expected = nlohmann::ordered_json::parse(request);
  auto cases = nlohmann::ordered_json::array();
  for (int k = 1; k <= kExtension; ++k) cases.push_back({{"clearance_mm", 0.1 + k / 3000.0}});
  auto added = expected;
  added["cases"] = cases;
  EXPECT_TRUE(store.queue.add_cases(sweep, cases, jobs::plan_sweep(added, 10'000).jobs));
  for (const auto& one : cases) expected["cases"].push_back(one);
  EXPECT_EQ(store.reader.find_sweep(sweep)->request, expected.dump());
  EXPECT_EQ(count_of(store, sweep, jobs::JobState::kQueued), 1 + kExtension);
  EXPECT_FALSE(store.queue.add_cases("swp_none", cases, {}));
}

TEST(SweepState, FollowsFromItsJobs) {
  // queued, running, succeeded, failed, cancelled
  EXPECT_EQ(jobs::sweep_state({3, 0, 0, 0, 0}), "queued");
  EXPECT_EQ(jobs::sweep_state({2, 1, 0, 0, 0}), "running");
  EXPECT_EQ(jobs::sweep_state({2, 0, 1, 0, 0}), "running");
  EXPECT_EQ(jobs::sweep_state({0, 0, 3, 0, 0}), "succeeded");
  EXPECT_EQ(jobs::sweep_state({0, 0, 2, 1, 0}), "failed");
  EXPECT_EQ(jobs::sweep_state({0, 0, 1, 1, 1}), "cancelled");
}

}  // namespace
}  // namespace jobs_tests
