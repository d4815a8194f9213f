// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/batch_files.h"

#include <fstream>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/cluster/plan_tasks.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using jobs::cluster::FileError;
using jobs::cluster::BatchIndex;
using jobs::cluster::plan_tasks;
using jobs::cluster::TaskPlan;
using testing::ElementsAre;

TEST(TaskList, ReadsBackWhatWasWritten) {
  const std::vector<TaskPlan> tasks{
      {.indices = {0, 1, 2, 7, 9, 10}, .tries = 2, .strikes = 1, .memory_factor = 2, .time_factor = 4},
      {.indices = {3}}};
  EXPECT_EQ(jobs::cluster::read_task_list(jobs::cluster::write_task_list(tasks)), tasks);
  EXPECT_EQ(jobs::cluster::write_task_list(tasks),
            "0-2,7,9-10 tries 2 strikes 1 memory 2 time 4\n3 tries 0 strikes 0 memory 1 time 1\n");
}

TEST(TaskList, RefusesWhatIsNone) {
  for (const char* const text : {"0-2 tries\n", "x tries 0 strikes 0 memory 1 time 1\n",
                                 "1 tries 0 strikes 0 memory one time 1\n", "<html>\n"}) {
    EXPECT_THROW((void)jobs::cluster::read_task_list(text), FileError) << text;
  }
}

TEST(BatchJobs, AreReadOneByOne) {
  const TemporaryStore folder;
  const auto file = folder.file();
  const jobs::cluster::BatchJobs all{{0, "{\"a\":1}"}, {1, ""}, {4, std::string(100'000, 'x')}};
  const jobs::JobLimits limits{.wall_time_s = 3.0, .steps = 5, .memory_bytes = 7};
  const jobs::cluster::BatchHeader written{
      .batch = "bat_1", .engine = "e1", .limits = limits, .deliver_every_s = 9.0};
  jobs::cluster::write_durably(file, jobs::cluster::encode_jobs(written, all));
  jobs::cluster::BatchHeader header;
  const auto some = jobs::cluster::read_jobs(file, {0, 4}, header);
  EXPECT_EQ(some, (jobs::cluster::BatchJobs{{0, all.at(0)}, {4, all.at(4)}}));
  EXPECT_EQ(header.batch, "bat_1");
  EXPECT_EQ(header.engine, "e1");
  EXPECT_EQ(header.limits.steps, 5);
  EXPECT_EQ(header.deliver_every_s, 9.0);
  EXPECT_THROW((void)jobs::cluster::read_jobs(file, {2}, header), FileError);
  EXPECT_THROW((void)jobs::cluster::read_jobs(file.parent_path() / "none", {0}, header), FileError);
}

jobs::cluster::ResultFile some_results() {
  jobs::cluster::ResultFile file{.batch = "bat_1",
                                 .provenance = {.host = "n1",
                                                .cpu = "C",
                                                .libm = "glibc 2.36",
                                                .numerics = "native",
                                                .version = "1",
                                                .commit = "c",
                                                .compiler = "g",
                                                .engine = "e"},
                                 .results = {}};
  jobs::RunRecord good;
  good.metrics = {{"steps", 12}, {"peak", 0.1}, {"none", nullptr}};
  good.wall_time_s = 0.25;
  jobs::RunRecord bad;
  bad.end = jobs::RunRecord::End::kFailed;
  bad.error_reason = "non_finite";
  bad.error_detail = "no number";
  bad.error_t_s = 0.5;
  file.results = {{.batch_index = 3, .record = good, .packed_trajectory = std::string("\0\1blob", 6)},
                  {.batch_index = 9, .record = bad, .packed_trajectory = {}}};
  return file;
}

TEST(Results, ReadBackToTheBit) {
  const auto read = jobs::cluster::decode_results(jobs::cluster::encode_results(some_results()));
  EXPECT_EQ(read.batch, "bat_1");
  EXPECT_EQ(read.provenance.libm, "glibc 2.36");
  EXPECT_EQ(read.provenance.engine, "e");
  ASSERT_EQ(read.results.size(), 2U);
  EXPECT_EQ(read.results[0].batch_index, 3U);
  EXPECT_EQ(read.results[0].record.metrics.dump(), R"({"none":null,"peak":0.1,"steps":12})");
  EXPECT_EQ(read.results[0].record.wall_time_s, 0.25);
  EXPECT_EQ(read.results[0].packed_trajectory, std::string("\0\1blob", 6));
  EXPECT_EQ(read.results[1].record.end, jobs::RunRecord::End::kFailed);
  EXPECT_EQ(read.results[1].record.error_reason, "non_finite");
  EXPECT_EQ(read.results[1].record.error_t_s, 0.5);
}

TEST(Results, AreRefusedWithAnyByteChangedOrMissing) {
  const std::string good = jobs::cluster::encode_results(some_results());
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string damaged = good;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    EXPECT_THROW((void)jobs::cluster::decode_results(damaged), FileError) << i;
    EXPECT_THROW((void)jobs::cluster::decode_results(std::string_view(good).substr(0, i)), FileError) << i;
  }
}

TEST(DurableFile, IsWholeAndLeavesNothingElse) {
  const TemporaryStore folder;
  jobs::cluster::write_durably(folder.file(), "first");
  jobs::cluster::write_durably(folder.file(), "second");
  EXPECT_EQ(jobs::cluster::read_whole(folder.file()), "second");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.file().parent_path()), {}), 1);
  EXPECT_THROW(jobs::cluster::write_durably(folder.file() / "below", "x"), FileError);
}

std::vector<BatchIndex> indices(std::size_t count) {
  std::vector<BatchIndex> all(count);
  std::iota(all.begin(), all.end(), BatchIndex{0});
  return all;
}

TEST(PlanTasks, HasEveryJobOnceInOrder) {
  for (const std::size_t n : {1U, 2U, 7U, 100U, 1001U}) {
    std::vector<double> costs(n);
    for (std::size_t i = 0; i < n; ++i) costs[i] = static_cast<double>(i * i % 17);
    std::vector<BatchIndex> all;
    for (const TaskPlan& task :
         plan_tasks(indices(n), costs,
                    {.threads = 2, .slots = 3, .most_tasks = 50, .task_s = 10.0, .least_task_s = 0.1})) {
      EXPECT_FALSE(task.indices.empty());
      all.insert(all.end(), task.indices.begin(), task.indices.end());
    }
    EXPECT_EQ(all, indices(n));
  }
}

TEST(PlanTasks, MakesThreeTasksASlotUnlessTheyAreTooShortOrTooLong) {
  const std::vector<double> costs(6000, 1.0);
  const auto count = [&](double task_s, double least_task_s, int most) {
    return plan_tasks(indices(6000), costs,
                      {.threads = 1,
                       .slots = 10,
                       .most_tasks = most,
                       .task_s = task_s,
                       .least_task_s = least_task_s})
        .size();
  };
  EXPECT_EQ(count(600.0, 60.0, 1000), 30U);
  EXPECT_EQ(count(100.0, 60.0, 1000), 60U);    // none longer than 100 s
  EXPECT_EQ(count(600.0, 500.0, 1000), 12U);   // none shorter than 500 s
  EXPECT_EQ(count(600.0, 60.0, 20), 20U);      // and no more than are allowed
}

TEST(PlanTasks, SharesOutCostsRatherThanJobs) {
  const auto tasks =
      plan_tasks(indices(4), {9.0, 1.0, 1.0, 9.0},
                 {.threads = 1, .slots = 1, .most_tasks = 2, .task_s = 10.0, .least_task_s = 1.0});
  ASSERT_EQ(tasks.size(), 2U);
  EXPECT_THAT(tasks[0].indices, ElementsAre(0U, 1U));
}

}  // namespace
}  // namespace jobs_tests
