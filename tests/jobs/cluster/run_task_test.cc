// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/run_task.h"

#include <atomic>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/cluster/batch.h"
#include "jobs/requests/parameters.h"
#include "jobs/runs/run_record.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using jobs::cluster::FileError;
using jobs::cluster::BatchIndex;

/// A batch of three jobs that one task is to compute: its crank velocities are 5, 6 and 7 rad/s.
class TaskTest : public testing::Test {
 protected:
  void prepare(const std::string& engine = jobs::engine_version(), double deliver_every_s = 1e6) {
    std::vector<jobs::BatchJob> all;
    for (const std::uint32_t batch_index : {0U, 1U, 2U}) {
      const nlohmann::json given{
          {"crank_velocity_rad_s", 5 + batch_index}, {"duration_s", 0.1}, {"run_up_s", 0.05}};
      all.push_back({.batch_index = batch_index,
                     .parameters = jobs::complete_parameters(given, "").dump(),
                     .kind = {},
                     .duration_s = 0.1});
    }
    batch_.prepare({.batch = "bat_1", .engine = engine, .limits = {}, .deliver_every_s = deliver_every_s},
                   all);
    batch_.add_generation({{.indices = {0, 1, 2}}}, "");
  }

  bool run(const jobs::Runner& runner, const std::function<bool()>& stop = [] { return false; }) {
    return jobs::cluster::run_task(
        {.folder = batch_.folder().path, .generation = 0, .index = 0, .threads = 1, .runner = runner}, stop,
        [](const std::string&) {});
  }

  /// The indices of all results that lie in the folder.
  std::vector<BatchIndex> delivered() {
    std::vector<BatchIndex> indices;
    for (const auto& file : batch_.find_new_results()) {
      for (const auto& result : jobs::cluster::decode_results(jobs::cluster::read_whole(file)).results)
        indices.push_back(result.batch_index);
    }
    std::ranges::sort(indices);
    return indices;
  }

  /// Computes the first job at once; the others go on until they are stopped.
  jobs::Runner slow_after_the_first() {
    return [this](const jobs::JobSpec& spec, const engine::StopQuery& stop_requested) {
      if (spec.parameters.crank_velocity > 5.5) {
        others_ = true;
        while (!stop_requested(0.0)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        engine::RunResult stopped;
        stopped.status = engine::RunStatus::kStopped;
        return stopped;
      }
      return engine_.runner()(spec, stop_requested);
    };
  }

  TemporaryStore temporary_;
  FakeEngine engine_;
  std::atomic<bool> others_ = false;
  jobs::cluster::Batch batch_{{.seq = 1, .id = "bat_1", .sweep_id = {}}, temporary_.file().parent_path(), {}};
};

TEST_F(TaskTest, LeavesAllResultsInOneFile) {
  prepare();
  EXPECT_TRUE(run(engine_.runner()));
  EXPECT_EQ(batch_.find_new_results().size(), 1U);
  EXPECT_THAT(delivered(), testing::ElementsAre(0U, 1U, 2U));
}

TEST_F(TaskTest, DoesNotComputeAgainWhatItHasLeftBefore) {
  prepare();
  EXPECT_TRUE(run(engine_.runner()));
  EXPECT_TRUE(run(engine_.runner()));  // Slurm has started it again
  EXPECT_EQ(engine_.begun_speeds().size(), 3U);
}

TEST_F(TaskTest, LeavesWhatIsReadyWhenItIsToldToEnd) {
  prepare();
  EXPECT_FALSE(run(slow_after_the_first(), [&] { return others_.load(); }));
  EXPECT_THAT(delivered(), testing::ElementsAre(0U));
  EXPECT_TRUE(run(engine_.runner()));
  EXPECT_THAT(delivered(), testing::ElementsAre(0U, 1U, 2U));
}

TEST_F(TaskTest, LeavesWhatIsReadyNowAndThen) {
  prepare(jobs::engine_version(), 0.001);
  std::atomic<bool> seen = false;
  EXPECT_FALSE(run(slow_after_the_first(), [&] {
    seen = seen || !batch_.find_new_results().empty();
    return seen.load();
  }));
  EXPECT_THAT(delivered(), testing::ElementsAre(0U));
}

TEST_F(TaskTest, EndsWhenTheBatchIsCancelled) {
  prepare();
  std::ofstream(batch_.folder().cancel()).flush();
  EXPECT_FALSE(run(slow_after_the_first()));
}

TEST_F(TaskTest, RefusesABatchForAnotherEngine) {
  prepare("of yesterday");
  EXPECT_THROW(run(engine_.runner()), FileError);
  EXPECT_THAT(delivered(), testing::IsEmpty());
}

TEST_F(TaskTest, RefusesATaskThatIsNotThere) {
  prepare();
  const jobs::cluster::TaskOrder order{
      .folder = batch_.folder().path, .generation = 0, .index = 1, .threads = 1, .runner = engine_.runner()};
  EXPECT_THROW(jobs::cluster::run_task(order, [] { return false; }, [](const std::string&) {}), FileError);
}

}  // namespace
}  // namespace jobs_tests
