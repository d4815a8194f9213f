// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "jobs/base/ids.h"
#include "jobs/base/states.h"
#include "jobs/base/time_text.h"
#include "jobs/results/resource_json.h"
#include "jobs/store/store.h"
#include "tests/jobs/service_support.h"
#include "tests/jobs/store/store_support.h"

namespace jobs_tests {
namespace {

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

TEST(Store, ListsTheJobsInAStateNewestFirst) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": {"from": 1, "to": 2, "count": 24}}})");
  {
    SQLite::Database other(temporary.file().string(), SQLite::OPEN_READWRITE);
    other.exec("INSERT INTO batches (seq, id, engine_version, created_ms) VALUES (1, 'bat_1', '', 1)");
    other.exec(
        "UPDATE jobs SET state = CASE seq % 5 WHEN 1 THEN 'running' WHEN 2 THEN 'succeeded' WHEN 3 THEN "
        "'failed' WHEN 4 THEN 'cancelled' ELSE 'queued' END");
    other.exec("UPDATE jobs SET batch = 1, place = seq WHERE seq % 5 < 2 AND seq % 2 = 0");
    constexpr const char* kIndex = "SELECT count(*) FROM sqlite_schema WHERE name = 'unsuccessful_jobs'";
    EXPECT_EQ(other.execAndGet(kIndex).getInt(), 1) << "by which the failed and cancelled ones are found";
  }
  const auto all = store.reader.list_jobs("", "", 100);
  ASSERT_EQ(all.size(), 24U);
  for (const std::string_view state : jobs::kJobStates) {
    std::vector<std::string> expected, listed;
    for (const jobs::JobRow& job : all)
      if (job.state == state) expected.push_back(job.id);
    EXPECT_GE(expected.size(), 4U);
    for (std::string before; listed.size() < expected.size(); before = listed.back()) {
      const auto page = store.reader.list_jobs(std::string(state), before, 2);
      ASSERT_FALSE(page.empty()) << state;
      for (const jobs::JobRow& job : page) listed.push_back(job.id);
    }
    EXPECT_EQ(listed, expected) << state;
  }
}

constexpr std::int64_t kDay_ms = 24LL * 3600 * 1000;

TEST(Store, MakesIdsThatFollowThoseOfAClockThatWasAhead) {
  const TemporaryStore temporary;
  {
    jobs::Store store(temporary.file());
    add_sweep(store, kThreeJobs);
  }
  const std::string ahead = jobs::IdMaker().make(jobs::kSweepPrefix, jobs::now_unix_ms() + kDay_ms);
  execute_sql(temporary.file(), "UPDATE sweeps SET id = '" + ahead + "'");
  jobs::Store store(temporary.file());
  const std::string id = add_sweep(store, kThreeJobs);
  EXPECT_GT(id, ahead);
  EXPECT_EQ(store.reader.list_sweeps("", "", 10).front().id, id);
}

TEST(Store, EndsNoStudyBeforeItWasMadeAndItsJobsEnded) {
  const TemporaryStore temporary;
  std::string made, computed;
  {
    jobs::Store store(temporary.file());
    for (std::string* const id : {&made, &computed})
      *id = store.studies.add(jobs::kSearchPrefix, stored_plan_of("{}"), "{}", "{}", 10);
    static_cast<void>(store.queue.cancel_sweep(store.studies.find(computed)->sweep_id));
  }
  const std::int64_t ahead = jobs::now_unix_ms() + kDay_ms;
  execute_sql(temporary.file(), "UPDATE sweeps SET created_ms = " + std::to_string(ahead));
  execute_sql(temporary.file(),
              "UPDATE jobs SET ended_ms = " + std::to_string(ahead + 1) + " WHERE ended_ms IS NOT NULL");
  jobs::Store store(temporary.file());
  EXPECT_TRUE(store.studies.set_state(made, "running", "failed"));
  EXPECT_TRUE(store.studies.set_state(computed, "running", "cancelled"));
  EXPECT_EQ(store.studies.find(made)->ended_ms, ahead);
  EXPECT_EQ(store.studies.find(computed)->ended_ms, ahead + 1);
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
  EXPECT_FALSE(store.queue.record(job, successful_run(1.0)));
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
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), successful_run(5.0)));
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
    EXPECT_TRUE(store.queue.record(store.queue.claim().value(), successful_run(5.0)));
    EXPECT_TRUE(store.queue.record(store.queue.claim().value(), successful_run(10.0)));
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
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), successful_run(1.0)));
  const std::string sweep = add_sweep(
      store, R"({"sweep": {"coupler": ["rigid", "flexible"], "crank_velocity_rad_s": [5, 10, 12]}})");
  auto costs = store.reader.find_sweep(sweep).value().costs;
  EXPECT_EQ(costs.at("rigid, clearance").computed, 0);
  EXPECT_EQ(costs.at("rigid, clearance").queued, 2);
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), successful_run(1.0)));
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
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), successful_run(1.0)));
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
    EXPECT_EQ(row.rivals[0]->priority, 3);
    EXPECT_EQ(row.rivals[0]->unit_s, 7.0);
    EXPECT_EQ(row.rivals[0]->costs.at("rigid, clearance").queued, 1);
    EXPECT_EQ(row.rivals[0]->costs.at("rigid, clearance").running.size(), 1U);
    EXPECT_EQ(row.cost_rates.at("rigid, clearance"), 0.5) << "2 s for 4 s of the ended sweep";
  }
  const auto row = store.reader.find_sweep(first).value();
  EXPECT_EQ(row.unit_s, 7.0);
  ASSERT_EQ(row.rivals.size(), 1U);
  EXPECT_EQ(row.rivals[0]->costs.at("rigid, clearance").queued_s, 6.0);
}

TEST(Store, SharesTheRivalsOfTheSweepsOfAListing) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  for (const char* const request :
       {R"({"sweep": {"clearance_mm": [0.1]}})", R"({"sweep": {"clearance_mm": [0.2]}})",
        R"({"sweep": {"clearance_mm": [0.3]}})"})
    add_sweep(store, request);
  const auto rows = store.reader.list_sweeps("", "", 3);
  ASSERT_EQ(rows.size(), 3U);
  for (const jobs::SweepRow& row : rows) ASSERT_EQ(row.rivals.size(), 2U);
  // In their order: the newest has the first and the second, the second the first and the newest.
  EXPECT_EQ(rows[0].rivals[0], rows[1].rivals[0]);
  EXPECT_EQ(rows[0].rivals[1], rows[2].rivals[0]);
  EXPECT_EQ(rows[1].rivals[1], rows[2].rivals[1]);
}

// A run takes 2 s on the wall here, whatever it simulates.
TEST(Store, CountsTheTimeThatJobsSimulateIfASweepVariesIt) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string sweep = add_sweep(store, R"({"sweep": {"crank_velocity_rad_s": [5], "duration_s": [0.5, 2, 6, 7]}})");
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), successful_run(1.0)));
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
  EXPECT_TRUE(store.queue.record(store.queue.claim().value(), successful_run(1.0)));
  EXPECT_EQ(store.reader.has_sweep_ended(sweep), false);  // one queued
  const auto last = store.queue.claim().value();
  EXPECT_EQ(store.reader.has_sweep_ended(sweep), false);  // one running
  const auto jobs = store.reader.find_results(sweep)->rows;
  EXPECT_EQ(store.reader.has_job_ended(jobs[0].job_id), true);
  EXPECT_EQ(store.reader.has_job_ended(jobs[1].job_id), false);
  EXPECT_TRUE(store.queue.record(last, failed_run()));
  EXPECT_EQ(store.reader.has_job_ended(jobs[1].job_id), true);
  EXPECT_EQ(store.reader.has_sweep_ended(sweep), true);
}

TEST(Store, TellsWhichResultsAreNew) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string sweep = add_sweep(store, kThreeJobs);
  EXPECT_TRUE(store.reader.find_ended(sweep, 0).empty());
  store.queue.record(store.queue.claim().value(), successful_run(1.0));
  const auto first = store.reader.find_ended(sweep, 0);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].swept, "[5.0]");
  EXPECT_EQ(first[0].metrics, R"({"peak":1.0})");
  store.queue.record(store.queue.claim().value(), failed_run());
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
