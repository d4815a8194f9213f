// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <cmath>
#include <new>
#include <thread>

#include <gtest/gtest.h>

#include "jobs/local/local_pool.h"
#include "jobs/requests/parameters.h"
#include "jobs/trajectories/trajectory_codec.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using namespace std::chrono_literals;

jobs::ClaimedJob numbered_job(int k) {
  return {.seq = k,
          .id = "job_" + std::to_string(k),
          .attempt = 1,
          .parameters = jobs::complete_parameters(nlohmann::json::object(), "").dump()};
}

void record_nothing(const jobs::ClaimedJob&, const jobs::RunRecord&, const jobs::OnClaim&) {}

TEST(LocalPool, KeepsAResultThatCannotBeStoredYetAndOffersItAgain) {
  FakeEngine engine;
  std::atomic<int> claims = 0;
  std::atomic<int> offers = 0;
  std::atomic<int> logs = 0;
  std::atomic<bool> stored = false;
  jobs::LocalPool pool(
      {.claim =
           [&](const jobs::OnClaim& on_claim) {
             if (claims++ == 0) on_claim(numbered_job(1));
           },
       .record =
           [&](const jobs::ClaimedJob& claimed, const jobs::RunRecord& record, const jobs::OnClaim&) {
             EXPECT_EQ(claimed.id, "job_1");
             EXPECT_EQ(record.end, jobs::RunRecord::End::kSucceeded);
             if (offers++ == 0) throw jobs::StorageError("disk full", 13, jobs::Disk::kFull);
             stored = true;
             stored.notify_all();
           },
       .requeue = [](const jobs::ClaimedJob&) { ADD_FAILURE() << "a finished job was given back"; }},
      engine.runner(), 1, [&](const std::string& text) {
        ++logs;
        EXPECT_NE(text.find("disk full"), std::string::npos);
      });
  stored.wait(false);
  EXPECT_EQ(offers, 2);
  EXPECT_EQ(logs, 1);
  EXPECT_EQ(engine.begun_speeds().size(), 1U);  // computed once
}

TEST(LocalPool, OutlivesAStoreThatCannotBeClaimedFrom) {
  FakeEngine engine;
  std::atomic<int> claims = 0;
  std::atomic<bool> done = false;
  jobs::LocalPool pool({.claim = [&](const jobs::OnClaim&) {
                          if (claims++ == 0) throw jobs::StorageError("disk full", 13, jobs::Disk::kFull);
                          done = true;
                          done.notify_all();
                        },
                        .record = record_nothing,
                        .requeue = [](const jobs::ClaimedJob&) {}},
                       engine.runner(), 1, [](const std::string&) {});
  done.wait(false);
  EXPECT_GE(claims, 2);
}

TEST(LocalPool, OutlivesALogThatHasNoMemory) {
  FakeEngine engine;
  std::atomic<int> claims = 0;
  std::atomic<bool> done = false;
  jobs::LocalPool pool({.claim = [&](const jobs::OnClaim&) {
                          if (claims++ == 0) throw std::bad_alloc();
                          done = true;
                          done.notify_all();
                        },
                        .record = record_nothing,
                        .requeue = [](const jobs::ClaimedJob&) {}},
                       engine.runner(), 1, [](const std::string&) { throw std::bad_alloc(); });
  done.wait(false);
  EXPECT_EQ(claims, 2);
}

TEST(LocalPool, ComputesTheJobThatARecordHandsOverAndCanStopIt) {
  FakeEngine engine;
  std::atomic<int> claims = 0;
  std::atomic<int> records = 0;
  std::atomic<bool> handed_over = false;
  jobs::LocalPool pool(
      {.claim =
           [&](const jobs::OnClaim& on_claim) {
             if (claims++ == 0) on_claim(numbered_job(1));
           },
       .record =
           [&](const jobs::ClaimedJob& job, const jobs::RunRecord& record, const jobs::OnClaim& on_claim) {
             if (records == 0) {
               engine.hold();
               on_claim(numbered_job(2));
               handed_over = true;
               handed_over.notify_all();
             } else {
               EXPECT_EQ(job.id, "job_2");
               EXPECT_EQ(record.end, jobs::RunRecord::End::kStopped);
               EXPECT_EQ(claims, 1);
             }
             ++records;
             records.notify_all();
           },
       .requeue = [](const jobs::ClaimedJob&) { ADD_FAILURE(); }},
      engine.runner(), 1, [](const std::string&) {});
  handed_over.wait(false);
  pool.stop_job("job_2", 1);  // which may not have begun yet
  for (int seen = records; seen < 2; seen = records) records.wait(seen);
}

// A cancel commits, a retry queues the job again and its new attempt begins, and only then the cancel stops what
// it found running.
TEST(LocalPool, StopsTheAttemptThatWasCancelledAndNoLaterOne) {
  FakeEngine engine;
  engine.hold();
  std::atomic<int> claims = 0;
  std::atomic<bool> succeeded = false;
  jobs::LocalPool pool(
      {.claim =
           [&](const jobs::OnClaim& on_claim) {
             jobs::ClaimedJob job = numbered_job(1);
             job.attempt = 2;
             if (claims++ == 0) on_claim(job);
           },
       .record =
           [&](const jobs::ClaimedJob&, const jobs::RunRecord& record, const jobs::OnClaim&) {
             EXPECT_EQ(record.end, jobs::RunRecord::End::kSucceeded);
             succeeded = true;
             succeeded.notify_all();
           },
       .requeue = [](const jobs::ClaimedJob&) { ADD_FAILURE(); }},
      engine.runner(), 1, [](const std::string&) {});
  engine.await_running(1);
  pool.stop_job("job_1", 1);
  engine.release();
  succeeded.wait(false);
  EXPECT_EQ(engine.stopped(), 0);
}

TEST(LocalPool, OffersAResultAloneThatCouldNotBeStoredWithTheNextJob) {
  FakeEngine engine;
  std::atomic<int> claims = 0;
  std::atomic<int> records = 0;
  jobs::LocalPool pool(
      {.claim =
           [&](const jobs::OnClaim& on_claim) {
             if (claims++ == 0) on_claim(numbered_job(1));
           },
       .record =
           [&](const jobs::ClaimedJob& job, const jobs::RunRecord&, const jobs::OnClaim& on_claim) {
             EXPECT_EQ(job.id, "job_1");
             if (records++ == 0) {
               on_claim(numbered_job(2));
               throw std::bad_alloc();  // so that nothing has been claimed
             }
             EXPECT_FALSE(on_claim);
             records.notify_all();
           },
       .requeue = [](const jobs::ClaimedJob&) { ADD_FAILURE(); }},
      engine.runner(), 1, [](const std::string&) {});
  for (int seen = records; seen < 2; seen = records) records.wait(seen);
  EXPECT_EQ(engine.begun_speeds().size(), 1U);
}

TEST(LocalPool, GivesBackAJobThatItIsHandedAsItStops) {
  FakeEngine engine;
  std::atomic<int> claims = 0;
  std::atomic<bool> recording = false;
  std::atomic<bool> stopping = false;
  std::vector<std::string> given_back;
  jobs::LocalPool pool(
      {.claim =
           [&](const jobs::OnClaim& on_claim) {
             if (claims++ == 0) on_claim(numbered_job(1));
           },
       .record =
           [&](const jobs::ClaimedJob&, const jobs::RunRecord&, const jobs::OnClaim& on_claim) {
             engine.hold();
             recording = true;
             recording.notify_all();
             stopping.wait(false);
             std::this_thread::sleep_for(50ms);
             on_claim(numbered_job(2));
           },
       .requeue = [&](const jobs::ClaimedJob& job) { given_back.push_back(job.id); }},
      engine.runner(), 1, [](const std::string&) {});
  recording.wait(false);
  stopping = true;
  stopping.notify_all();
  pool.stop();
  EXPECT_EQ(given_back, std::vector<std::string>{"job_2"});
  EXPECT_EQ(claims, 1);
}

TEST(LocalPool, SleepsWhileThereIsNothingToDo) {
  FakeEngine engine;
  std::atomic<int> claims = 0;
  jobs::LocalPool pool({.claim = [&](const jobs::OnClaim&) { ++claims; claims.notify_all(); },
                        .record = record_nothing,
                        .requeue = [](const jobs::ClaimedJob&) {}},
                       engine.runner(), 1, [](const std::string&) {});
  claims.wait(0);
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(claims, 1);
  pool.wake();
  claims.wait(1);
  EXPECT_EQ(claims, 2);
}

TEST(LocalPool, StopsAtOnceWhileItWaitsForTheDisk) {
  FakeEngine engine;
  std::atomic<int> claims = 0;
  std::atomic<int> offers = 0;
  jobs::LocalPool pool({.claim = [&](const jobs::OnClaim& on_claim) {
                          if (claims++ == 0) on_claim(numbered_job(1));
                        },
                        .record =
                            [&](const jobs::ClaimedJob&, const jobs::RunRecord&, const jobs::OnClaim&) {
                              ++offers;
                              offers.notify_all();
                              throw jobs::StorageError("disk full", 13, jobs::Disk::kFull);
                            },
                        .requeue = [](const jobs::ClaimedJob&) {}},
                       engine.runner(), 1, [](const std::string&) {});
  const auto start = std::chrono::steady_clock::now();
  for (int seen = 0; seen < 3; seen = offers) offers.wait(seen);
  const auto two_pauses = std::chrono::steady_clock::now() - start;
  const auto stopping = std::chrono::steady_clock::now();
  pool.stop();
  // The third pause, twice as long as the second one, is longer than the first two.
  EXPECT_LT(std::chrono::steady_clock::now() - stopping, two_pauses);
}

TEST(RunAndRecord, TurnsWhateverIsThrownIntoAFailure) {
  const jobs::RunRecord record = jobs::run_and_record(
      {},
      [](const jobs::JobSpec&, const engine::StopQuery&) -> engine::RunResult {
        throw std::runtime_error("broken \xff text");
      },
      [](double) { return false; });
  EXPECT_EQ(record.end, jobs::RunRecord::End::kFailed);
  EXPECT_EQ(record.error_reason, "internal");
  EXPECT_NE(record.error_detail.find("broken"), std::string::npos);
  EXPECT_NO_THROW((void)nlohmann::json(record.error_detail).dump());
  const jobs::RunRecord odd = jobs::run_and_record(
      {}, [](const jobs::JobSpec&, const engine::StopQuery&) -> engine::RunResult { throw 7; },
      [](double) { return false; });
  EXPECT_EQ(odd.error_reason, "internal");
}

/// A run with that value for every metric.
jobs::RunRecord record_of(double metric, const engine::Trajectory& trajectory) {
  return jobs::run_and_record({}, [&](const jobs::JobSpec&, const engine::StopQuery&) {
    engine::RunResult result;
    result.metrics.assign(engine::metric_table().size(), metric);
    result.trajectory = trajectory;
    return result;
  }, [](double) { return false; });
}

TEST(RunAndRecord, WritesCountsAsIntegersAndWhatIsNoNumberAsNull) {
  const nlohmann::json counted = record_of(3.0, {}).metrics;
  const nlohmann::json none = record_of(std::nan(""), {}).metrics;
  int counts = 0;
  for (const auto& info : engine::metric_table()) {
    EXPECT_EQ(counted.at(info.key).is_number_integer(), info.integer) << info.key;
    EXPECT_EQ(counted.at(info.key), 3) << info.key;
    EXPECT_TRUE(none.at(info.key).is_null()) << info.key;
    counts += info.integer ? 1 : 0;
  }
  EXPECT_GT(counts, 0);
}

TEST(RunAndRecord, KeepsEveryChannelButTheTimeWithSinglePrecision) {
  engine::Trajectory trajectory;
  trajectory.channels = {{.key = "t_s", .help = ""},
                         {.key = "measured", .help = ""},
                         {.key = "drawn", .help = "", .single_precision = true}};
  trajectory.columns = {{0.1}, {0.1}, {0.1}};
  const std::string blob = jobs::encode_trajectory(record_of(1.0, trajectory).trajectory);
  const auto kept = jobs::decode_trajectory(std::as_bytes(std::span(blob)), {});
  EXPECT_EQ(kept.columns[0][0], 0.1);
  EXPECT_EQ(kept.columns[1][0], 0.1F);
  EXPECT_EQ(kept.columns[2][0], 0.1F);
}

TEST(RunAndRecord, RefusesATrajectoryThatIsNoTable) {
  engine::Trajectory trajectory;
  trajectory.channels = {{.key = "t_s", .help = ""}};
  const jobs::RunRecord record = record_of(1.0, trajectory);
  EXPECT_EQ(record.end, jobs::RunRecord::End::kFailed);
  EXPECT_EQ(record.error_reason, "internal");
}

TEST(RunAndRecord, RefusesAResultThatLacksMetrics) {
  const jobs::RunRecord record = jobs::run_and_record(
      {}, [](const jobs::JobSpec&, const engine::StopQuery&) { return engine::RunResult{}; },
      [](double) { return false; });
  EXPECT_EQ(record.end, jobs::RunRecord::End::kFailed);
  EXPECT_EQ(record.error_reason, "internal");
}

}  // namespace
}  // namespace jobs_tests
