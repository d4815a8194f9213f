// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/reconcile.h"

#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace jobs_tests {
namespace {

using namespace std::chrono_literals;
using jobs::cluster::Clock;
using jobs::cluster::Decision;
using jobs::cluster::Phase;
using jobs::cluster::BatchIndex;
using jobs::cluster::Reconciler;
using jobs::cluster::TaskName;
using jobs::cluster::TaskPlan;
using jobs::cluster::TaskReport;
using jobs::cluster::TaskState;
using jobs::cluster::TaskStates;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr auto kGrace = 60s;
constexpr TaskName kFirst{.generation = 0, .index = 0};
using Reports = std::map<TaskName, TaskReport>;

std::vector<BatchIndex> batch_indices(BatchIndex count) {
  std::vector<BatchIndex> all(count);
  std::iota(all.begin(), all.end(), BatchIndex{0});
  return all;
}

TaskState task_of(TaskPlan plan) { return {.plan = plan, .wanted = plan.indices, .refused = false}; }

TaskReport ended(Phase phase, const std::string& word) {
  return {.phase = phase, .word = word, .array_job = "7", .cpus = 1, .node = "n1", .reason = "None"};
}

/// Its node could not even write a log into the folder.
TaskReport failed_without_log() {
  TaskReport report = ended(Phase::kFailed, "FAILED");
  report.has_log = false;
  return report;
}

/// Decision about a task that stays as it is beyond the time for late files.
Decision after_grace(const TaskState& task, const Reports& reports) {
  Reconciler reconciler(kGrace);
  const TaskStates tasks{{kFirst, task}};
  const auto start = Clock::now();
  const Decision early = reconciler.decide(tasks, reports, start);
  EXPECT_THAT(early.submit, IsEmpty());
  EXPECT_THAT(early.fail, IsEmpty());
  EXPECT_THAT(reconciler.decide(tasks, reports, start + kGrace - 1s).submit, IsEmpty());
  return reconciler.decide(tasks, reports, start + kGrace);
}

struct LossCase {
  std::string name;
  Reports reports;
};

class Interrupted : public testing::TestWithParam<LossCase> {};

TEST_P(Interrupted, GivesTheSameJobsToANewTaskAndCountsOneTry) {
  const Decision decision =
      after_grace(task_of({.indices = batch_indices(3), .tries = 1, .strikes = 1}), GetParam().reports);
  EXPECT_THAT(decision.submit, ElementsAre(TaskPlan{.indices = batch_indices(3), .tries = 2, .strikes = 1}));
  EXPECT_THAT(decision.fail, IsEmpty());
  EXPECT_FALSE(decision.refused);
}

INSTANTIATE_TEST_SUITE_P(
    Losses, Interrupted,
    testing::Values(LossCase{"Absent", {}},
                    LossCase{"Cancelled", {{kFirst, ended(Phase::kCancelled, "CANCELLED")}}},
                    LossCase{"NodeFail", {{kFirst, ended(Phase::kNodeFail, "NODE_FAIL")}}},
                    LossCase{"Preempted", {{kFirst, ended(Phase::kPreempted, "PREEMPTED")}}},
                    LossCase{"FailedWithoutALog", {{kFirst, failed_without_log()}}}),
    [](const auto& each) { return each.param.name; });

class Alive : public testing::TestWithParam<Phase> {};

TEST_P(Alive, IsLeftAloneHoweverLongItTakes) {
  Reconciler reconciler(kGrace);
  const TaskStates tasks{{kFirst, task_of({.indices = batch_indices(2)})}};
  const auto start = Clock::now();
  for (const auto later : {0s, 60s, 100'000s}) {
    const Decision decision =
        reconciler.decide(tasks, {{kFirst, ended(GetParam(), "A_WORD_OF_TOMORROW")}}, start + later);
    EXPECT_THAT(decision.submit, IsEmpty());
    EXPECT_THAT(decision.cancel, IsEmpty());
    EXPECT_EQ(decision.running.size(), GetParam() == Phase::kRunning ? 2U : 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Phases, Alive,
                         testing::Values(Phase::kPending, Phase::kRunning, Phase::kUnknownWord),
                         [](const auto& each) { return std::to_string(static_cast<int>(each.param)); });

TEST(Reconciler, StartsTheTimeForLateFilesAgainWhenATaskIsSeenAlive) {
  Reconciler reconciler(kGrace);
  const TaskStates tasks{{kFirst, task_of({.indices = batch_indices(1)})}};
  const auto start = Clock::now();
  (void)reconciler.decide(tasks, {}, start);
  // started again by Slurm
  (void)reconciler.decide(tasks, {{kFirst, ended(Phase::kRunning, "RUNNING")}}, start + 50s);
  EXPECT_THAT(reconciler.decide(tasks, {}, start + 70s).submit, IsEmpty());
  EXPECT_THAT(reconciler.decide(tasks, {}, start + 130s).submit, SizeIs(1));
}

TEST(Reconciler, ReplacesALostTaskOnce) {
  Reconciler reconciler(kGrace);
  TaskStates tasks{{kFirst, task_of({.indices = batch_indices(2)})}};
  const auto start = Clock::now();
  (void)reconciler.decide(tasks, {}, start);
  EXPECT_THAT(reconciler.decide(tasks, {}, start + kGrace).submit, SizeIs(1));
  tasks.at(kFirst).wanted.clear();  // the new task has them now
  tasks[{.generation = 1, .index = 0}] = task_of({.indices = batch_indices(2), .tries = 1});
  EXPECT_THAT(reconciler.decide(tasks, {}, start + kGrace + 1s).submit, IsEmpty());
}

TEST(Reconciler, GivesOnlyWhatIsMissingToANewTask) {
  TaskState task = task_of({.indices = batch_indices(4), .tries = 4});
  task.wanted = {1, 3};
  const Decision decision = after_grace(task, {{kFirst, ended(Phase::kNodeFail, "NODE_FAIL")}});
  // it got on: that is no loss in a row
  EXPECT_THAT(decision.submit, ElementsAre(TaskPlan{.indices = {1, 3}, .tries = 1}));
}

TEST(Reconciler, SplitsATaskThatFailsTwiceIntoSingleJobs) {
  const Reports failed{{kFirst, ended(Phase::kFailed, "FAILED")}};
  EXPECT_THAT(after_grace(task_of({.indices = batch_indices(3)}), failed).submit,
              ElementsAre(TaskPlan{.indices = batch_indices(3), .tries = 1, .strikes = 1}));
  const auto parts =
      after_grace(task_of({.indices = batch_indices(3), .tries = 1, .strikes = 1}), failed).submit;
  EXPECT_THAT(parts, ElementsAre(TaskPlan{.indices = {0}, .tries = 2, .strikes = 2},
                                 TaskPlan{.indices = {1}, .tries = 2, .strikes = 2},
                                 TaskPlan{.indices = {2}, .tries = 2, .strikes = 2}));
}

TEST(Reconciler, SplitsALargeTaskIntoNoMorePartsThanSlurmIsToBear) {
  const auto parts = after_grace(task_of({.indices = batch_indices(1050), .strikes = 1}),
                                 {{kFirst, ended(Phase::kFailed, "FAILED")}})
                         .submit;
  EXPECT_EQ(parts.size(), jobs::cluster::kMostParts);
  std::vector<BatchIndex> all;
  for (const TaskPlan& part : parts) all.insert(all.end(), part.indices.begin(), part.indices.end());
  EXPECT_EQ(all, batch_indices(1050));
}

TEST(Reconciler, FailsAJobWhoseOwnTaskFailedTwice) {
  const Decision decision = after_grace(task_of({.indices = {5}, .tries = 2, .strikes = 2}),
                                        {{kFirst, ended(Phase::kFailed, "FAILED")}});
  EXPECT_THAT(decision.submit, IsEmpty());
  ASSERT_THAT(decision.fail, SizeIs(1));
  EXPECT_EQ(decision.fail[0].batch_index, 5U);
  EXPECT_EQ(decision.fail[0].reason, "task_failed");
  EXPECT_THAT(decision.fail[0].detail, testing::HasSubstr("FAILED on n1"));
}

TEST(Reconciler, TakesATaskThatCompletedWithoutAResultForOneThatFailed) {
  EXPECT_EQ(
      after_grace(task_of({.indices = batch_indices(1)}), {{kFirst, ended(Phase::kCompleted, "COMPLETED")}})
          .submit.at(0)
          .strikes,
      1);
}

TEST(Reconciler, HalvesWhatTakesTooLongAndGivesASingleJobMoreTime) {
  const Reports late{{kFirst, ended(Phase::kTimeout, "TIMEOUT")}};
  EXPECT_THAT(
      after_grace(task_of({.indices = batch_indices(5)}), late).submit,
      ElementsAre(TaskPlan{.indices = {0, 1}, .tries = 1}, TaskPlan{.indices = {2, 3, 4}, .tries = 1}));
  EXPECT_THAT(after_grace(task_of({.indices = {2}, .time_factor = 2}), late).submit,
              ElementsAre(TaskPlan{.indices = {2}, .tries = 1, .time_factor = 4}));
}

TEST(Reconciler, DoublesTheTimeOfASingleJobAsOftenAsNeeded) {
  const Reports late{{kFirst, ended(Phase::kTimeout, "TIMEOUT")}};
  TaskPlan plan{.indices = {2}};
  for (int losses = 0; losses < 10; ++losses) {
    const Decision decision = after_grace(task_of(plan), late);
    ASSERT_THAT(decision.submit, SizeIs(1));
    EXPECT_EQ(decision.submit[0].time_factor, 2 * plan.time_factor);
    plan = decision.submit[0];
  }
}

TEST(Reconciler, GivesMoreMemoryOnceAndThenTakesItForAFailure) {
  const Reports large{{kFirst, ended(Phase::kOutOfMemory, "OUT_OF_MEMORY")}};
  EXPECT_THAT(after_grace(task_of({.indices = batch_indices(2)}), large).submit,
              ElementsAre(TaskPlan{.indices = batch_indices(2), .tries = 1, .memory_factor = 2}));
  EXPECT_THAT(
      after_grace(task_of({.indices = batch_indices(2), .memory_factor = 2}), large).submit,
      ElementsAre(TaskPlan{.indices = batch_indices(2), .tries = 1, .strikes = 1, .memory_factor = 2}));
}

TEST(Reconciler, GivesUpAfterFiveLossesInARow) {
  const Decision decision = after_grace(task_of({.indices = batch_indices(2), .tries = 4}), {});
  EXPECT_THAT(decision.submit, IsEmpty());
  ASSERT_THAT(decision.fail, SizeIs(2));
  EXPECT_EQ(decision.fail[1].reason, "task_lost");
}

TEST(Reconciler, SubmitsWhatWasRefusedAgainWithoutCountingIt) {
  TaskState task = task_of({.indices = batch_indices(2), .tries = 4});
  task.refused = true;
  const Decision decision = after_grace(task, {});
  EXPECT_TRUE(decision.refused);
  EXPECT_THAT(decision.submit, ElementsAre(TaskPlan{.indices = batch_indices(2), .tries = 4}));
}

TEST(Reconciler, FailsWhatIsRefusedForItsMemoryOrTime) {
  for (TaskPlan plan :
       {TaskPlan{.indices = {0, 1}, .memory_factor = 2}, TaskPlan{.indices = {0}, .time_factor = 8}}) {
    Decision decision;
    for (int refusals = 1; refusals < jobs::cluster::kMostTries; ++refusals) {
      TaskState task = task_of(plan);
      task.refused = true;
      decision = after_grace(task, {});
      ASSERT_THAT(decision.submit, SizeIs(1)) << refusals;
      plan = decision.submit[0];
    }
    TaskState task = task_of(plan);
    task.refused = true;
    decision = after_grace(task, {});
    EXPECT_THAT(decision.submit, IsEmpty());
    EXPECT_FALSE(decision.refused) << "other sweeps get their turn";
    ASSERT_EQ(decision.fail.size(), plan.indices.size());
    EXPECT_EQ(decision.fail[0].reason, "task_failed");
    EXPECT_THAT(decision.fail[0].detail, testing::HasSubstr("sbatch refuses"));
  }
}

TEST(Reconciler, ReplacesAtOnceWhatSlurmHoldsBecauseItCannotStartIt) {
  TaskReport held = ended(Phase::kPending, "PENDING");
  held.reason = "launch failed requeued held";
  Reconciler reconciler(kGrace);
  const Decision decision =
      reconciler.decide({{kFirst, task_of({.indices = batch_indices(2)})}}, {{kFirst, held}}, Clock::now());
  EXPECT_THAT(decision.cancel, ElementsAre(kFirst));
  EXPECT_THAT(decision.submit, ElementsAre(TaskPlan{.indices = batch_indices(2), .tries = 1}));
}

TEST(Reconciler, CancelsWhatNobodyWants) {
  TaskState task = task_of({.indices = batch_indices(2)});
  task.wanted.clear();
  const TaskStates tasks{{kFirst, task}};
  const auto start = Clock::now();
  Reconciler reconciler(kGrace);
  EXPECT_THAT(reconciler.decide(tasks, {{kFirst, ended(Phase::kPending, "PENDING")}}, start).cancel,
              ElementsAre(kFirst));
  // One that runs is about to end by itself.
  const Reports running{{kFirst, ended(Phase::kRunning, "RUNNING")}};
  EXPECT_THAT(reconciler.decide(tasks, running, start + 1s).cancel, IsEmpty());
  EXPECT_THAT(reconciler.decide(tasks, running, start + 2s + kGrace).cancel, ElementsAre(kFirst));
  EXPECT_THAT(
      reconciler.decide(tasks, {{kFirst, ended(Phase::kCompleted, "COMPLETED")}}, start + 3s + kGrace).cancel,
      IsEmpty());
}

}  // namespace
}  // namespace jobs_tests
