// SPDX-License-Identifier: Apache-2.0
// Limits of jobs and of a store, and the end of jobs and requests beyond them.

#include <new>

#include <gtest/gtest.h>

#include "jobs/requests/expand.h"
#include "jobs/runs/job_limits.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/store.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using jobs::RunRecord;

constexpr std::size_t kMaxQueued = 100'000;

/// Runs until it is asked to stop.
engine::RunResult run_until_stopped(const jobs::JobSpec&, const engine::StopQuery& stop_requested) {
  engine::RunResult result;
  while (!stop_requested(result.t_end)) result.t_end += 1e-6;
  result.status = engine::RunStatus::kStopped;
  return result;
}

TEST(JobLimits, EndAJobThatTakesTooLong) {
  const RunRecord record = jobs::run_and_record({}, run_until_stopped, [](double) { return false; }, 0.05);
  EXPECT_EQ(record.end, RunRecord::End::kFailed);
  EXPECT_EQ(record.error_reason, "time_limit");
  EXPECT_GT(record.error_t_s.value(), 0.0);
  EXPECT_GT(record.wall_time_s, 0.05);
  EXPECT_LT(record.wall_time_s, 5.0);
}

TEST(JobLimits, AreNotWhatEndsACancelledJob) {
  const RunRecord record = jobs::run_and_record(
      {}, run_until_stopped, [](double t) { return t > 1e-3; }, 3600.0);
  EXPECT_EQ(record.end, RunRecord::End::kStopped);
}

TEST(JobLimits, RefuseATrajectoryThatIsTooLarge) {
  jobs::JobSpec spec;
  spec.options.duration = 10.0;
  spec.options.output_rate = 1000.0;
  const std::size_t needed = 10'001 * sizeof(double) * engine::channel_table(spec.parameters).size();
  EXPECT_NO_THROW((void)jobs::within_limits(spec, {.memory_bytes = needed}));
  EXPECT_NO_THROW((void)jobs::within_limits(spec, {}));
  const RunRecord record = jobs::run_and_record(
      spec,
      [&](const jobs::JobSpec& asked, const engine::StopQuery&) -> engine::RunResult {
        (void)jobs::within_limits(asked, {.memory_bytes = needed - 1});
        throw std::logic_error("was not refused");
      },
      [](double) { return false; });
  EXPECT_EQ(record.error_reason, "memory_limit");
}

TEST(JobLimits, TellAMachineWithoutMemoryFromAFault) {
  const RunRecord record = jobs::run_and_record(
      {}, [](const jobs::JobSpec&, const engine::StopQuery&) -> engine::RunResult { throw std::bad_alloc(); },
      [](double) { return false; });
  EXPECT_EQ(record.end, RunRecord::End::kFailed);
  EXPECT_EQ(record.error_reason, "memory_limit");
}

TEST(JobLimits, LowerTheStepsButDoNotRaiseThem) {
  const long of_engine = jobs::JobSpec{}.options.step_limit;
  EXPECT_EQ(jobs::within_limits({}, {.steps = 10}).options.step_limit, 10);
  EXPECT_EQ(jobs::within_limits({}, {.steps = of_engine + 1}).options.step_limit, of_engine);
  EXPECT_EQ(jobs::within_limits({}, {}).options.step_limit, of_engine);
}

TEST(StoreLimit, RefusesWhatHasNoRoomAndStoresNoneOfIt) {
  const TemporaryStore temporary;
  constexpr std::int64_t kLimit = 400'000;
  jobs::Store store(temporary.file(), {.most_bytes = kLimit});
  constexpr const char* kSmall = R"({"sweep": {"crank_velocity_rad_s": [5]}})";
  constexpr const char* kLarge =
      R"({"sweep": {"crank_velocity_rad_s": {"from": 1, "to": 2, "count": 5000}}})";
  const std::string kept =
      store.queue.add_sweep(jobs::plan_sweep(request_of(kSmall), 10'000), kSmall, kMaxQueued);
  EXPECT_THROW((void)store.queue.add_sweep(jobs::plan_sweep(request_of(kLarge), 10'000), kLarge, kMaxQueued),
               jobs::StoreLimitReached);
  EXPECT_THROW(store.queue.check_sweep(jobs::plan_sweep(request_of(kLarge), 10'000), kLarge, kMaxQueued),
               jobs::StoreLimitReached);
  EXPECT_NO_THROW(store.queue.check_sweep(jobs::plan_sweep(request_of(kSmall), 10'000), kSmall, kMaxQueued));
  EXPECT_THROW(store.queue.check_sweep(jobs::plan_sweep(request_of(kSmall), 10'000), kSmall, 1),
               jobs::QueueFull);
  EXPECT_EQ(store.reader.list_sweeps("", "", 10).size(), 1u);
  // The result of a job, too; it can be read and cancelled, and deleting makes room.
  const jobs::ClaimedJob job = store.queue.claim().value();
  RunRecord record;
  record.end = RunRecord::End::kFailed;
  record.error_reason = "internal";
  record.error_detail = std::string(kLimit, 'x');
  EXPECT_NO_THROW(store.check_room());
  EXPECT_THROW((void)store.queue.record(job, record), jobs::StoreLimitReached);
  EXPECT_EQ(store.reader.find_job(job.id).value().state, "running");
  EXPECT_THROW(store.check_room(), jobs::StoreLimitReached) << "no room for the result that came last";
  EXPECT_EQ(store.queue.cancel_sweep(kept).outcome, jobs::CancelOutcome::kDone);
  EXPECT_FALSE(store.queue.record(job, record)) << "nobody wants it any more";
  EXPECT_NO_THROW(store.check_room());
  EXPECT_EQ(store.queue.delete_sweep(kept), jobs::DeleteOutcome::kDone);
  EXPECT_NO_THROW(
      (void)store.queue.add_sweep(jobs::plan_sweep(request_of(kSmall), 10'000), kSmall, kMaxQueued));
}

TEST(StoreLimit, HoldsForWhatIsTriedAgain) {
  const TemporaryStore temporary;
  constexpr const char* kRequest =
      R"({"sweep": {"crank_velocity_rad_s": {"from": 1, "to": 2, "count": 500}}})";
  std::string id;
  {
    jobs::Store store(temporary.file());
    id = store.queue.add_sweep(jobs::plan_sweep(request_of(kRequest), 10'000), kRequest, kMaxQueued);
    EXPECT_EQ(store.queue.cancel_sweep(id).outcome, jobs::CancelOutcome::kDone);
  }
  jobs::Store store(temporary.file(), {.most_bytes = 100'000});
  EXPECT_THROW((void)store.queue.retry_sweep(id, kMaxQueued), jobs::StoreLimitReached);
  EXPECT_EQ(jobs::sweep_state(store.reader.find_sweep(id).value().counts), "cancelled");
}

TEST(StoreLimit, LeavesAReserveOfTheDiskToOthers) {
  const TemporaryStore temporary;
  constexpr const char* kRequest = R"({"sweep": {"crank_velocity_rad_s": [5]}})";
  const std::int64_t all_of_it =
      static_cast<std::int64_t>(std::filesystem::space(temporary.file().parent_path()).capacity);
  {
    jobs::Store store(temporary.file(), {.reserve_bytes = all_of_it + 1});
    EXPECT_THROW(
        (void)store.queue.add_sweep(jobs::plan_sweep(request_of(kRequest), 10), kRequest, kMaxQueued),
        jobs::StoreLimitReached);
    EXPECT_TRUE(store.reader.list_sweeps("", "", 10).empty());
  }
  jobs::Store store(temporary.file(), {.reserve_bytes = 1});
  EXPECT_NO_THROW(
      (void)store.queue.add_sweep(jobs::plan_sweep(request_of(kRequest), 10), kRequest, kMaxQueued));
}

}  // namespace
}  // namespace jobs_tests
