// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/slurm_executor.h"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/cluster/run_task.h"
#include "jobs/store/store_lock.h"
#include "tests/jobs/cluster/fake_slurm.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::ordered_json;
using testing::HasSubstr;

/// A service with a fake cluster, whose nodes are this test.
class ClusterTest : public testing::Test {
 protected:
  [[nodiscard]] jobs::ServiceOptions options() {
    jobs::ServiceOptions options = options_of(store_, engine_, 1);
    options.site = fake_.site();
    options.site.program = "/bin/true";  // what is copied is not run
    options.executor = "slurm";
    return options;
  }

  void start() { service_.emplace(options()); }

  std::string submit(int jobs) {
    ordered_json request{{"parameters", {{"duration_s", 0.1}, {"run_up_s", 0.05}}},
                         {"sweep", {{"crank_velocity_rad_s", ordered_json::array()}}}};
    for (int i = 0; i < jobs; ++i) request["sweep"]["crank_velocity_rad_s"].push_back(5 + i);
    return service_->submit_sweep(request).at("id");
  }

  static void wait_until(const std::function<bool()>& holds, const std::string& what) {
    for (const auto until = std::chrono::steady_clock::now() + 20s; !holds();) {
      if (std::chrono::steady_clock::now() > until) throw std::runtime_error("never: " + what);
      std::this_thread::sleep_for(2ms);
    }
  }

  /// The folder of the only batch, once its generation has been given to Slurm.
  std::filesystem::path await_generation(int generation) {
    std::filesystem::path found;
    wait_until([&] {
      if (fake_.count("sbatch") <= generation) return false;
      for (const auto& entry : std::filesystem::recursive_directory_iterator(fake_.site().folder)) {
        if (entry.path().filename() == "g" + std::to_string(generation) + ".list")
          found = entry.path().parent_path();
      }
      return !found.empty();
    }, "generation " + std::to_string(generation));
    return found;
  }

  /// Sets the state that squeue prints for all tasks of the first generations.
  void report_all(const std::filesystem::path& batch, int generations, const std::string& word,
                  const std::string& reason = "None") {
    std::string lines;
    for (int generation = 0; generation < generations; ++generation) {
      for (int index = 0; index < tasks_of(batch, generation); ++index) {
        lines += "rpsup-" + batch.filename().string() + "-g" + std::to_string(generation) + "|7|" +
                 std::to_string(index) + "|" + word + "|1|n1|";
        lines += reason + "\n";
      }
    }
    fake_.report(lines);
  }

  static int tasks_of(const std::filesystem::path& batch, int generation) {
    std::ifstream in(batch / ("g" + std::to_string(generation) + ".list"));
    int count = 0;
    for (std::string line; std::getline(in, line);) ++count;
    return count;
  }

  void compute(const std::filesystem::path& batch, int generation) {
    for (int index = 0; index < tasks_of(batch, generation); ++index) {
      EXPECT_TRUE(jobs::cluster::run_task(
          {.folder = batch,
           .generation = generation,
           .index = index,
           .threads = 1,
           .runner = engine_.runner()},
          [] { return false; }, [](const std::string& text) { ADD_FAILURE() << text; }));
    }
  }

  nlohmann::json counts(const std::string& id) { return service_->find_sweep(id)->at("counts"); }
  nlohmann::json status() { return service_->list_executors().at("items").at(0); }

  TemporaryStore store_;
  FakeEngine engine_;
  FakeSlurm fake_;
  std::optional<jobs::Service> service_;
};

TEST_F(ClusterTest, HasTheResultsThatTheLocalPoolHas) {
  start();
  const std::string id = submit(3);
  const auto batch = await_generation(0);
  report_all(batch, 1, "RUNNING");
  wait_until([&] { return counts(id).at("running") == 3; }, "three jobs run");
  EXPECT_EQ(status().at("nodes"), nlohmann::json({"n1"}));
  compute(batch, 0);
  ASSERT_TRUE(service_->wait_for_sweep(id, 300s));
  const auto rows = service_->find_results(id)->rows;
  report_all(batch, 1, "COMPLETED");
  wait_until([&] { return !std::filesystem::exists(batch); },
             "the folder of a batch that is done is removed");

  TemporaryStore other;
  FakeEngine same;
  jobs::Service local(options_of(other, same, 1));
  service_.reset();
  const auto sent = ordered_json::parse(
      R"({"parameters": {"duration_s": 0.1, "run_up_s": 0.05}, "sweep": {"crank_velocity_rad_s": [5, 6,
         7]}})");
  const std::string local_id = local.submit_sweep(sent).at("id");
  ASSERT_TRUE(local.wait_for_sweep(local_id, 300s));
  const auto expected = local.find_results(local_id)->rows;
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // all but the job's id
    EXPECT_TRUE(std::equal(rows[i].begin() + 1, rows[i].end(), expected[i].begin() + 1, expected[i].end()))
        << i;
  }
}

TEST_F(ClusterTest, ComputesJobsOfNoSweep) {
  start();
  const std::string id = service_->submit_job({{"duration_s", 0.1}, {"run_up_s", 0.05}}).at("id");
  compute(await_generation(0), 0);
  wait_until([&] { return service_->find_job(id)->at("state") == "succeeded"; }, "the job succeeds");
}

TEST_F(ClusterTest, ComputesASetOnceThatTwoSweepsHave) {
  start();
  const std::string first = submit(2);
  const auto batch = await_generation(0);
  const std::string second = submit(2);
  compute(batch, 0);
  EXPECT_TRUE(service_->wait_for_sweep(first, 300s));
  EXPECT_TRUE(service_->wait_for_sweep(second, 300s));
  EXPECT_EQ(engine_.begun_speeds().size(), 2U);
  EXPECT_EQ(fake_.count("sbatch"), 1);
}

TEST_F(ClusterTest, WakesTheLocalPoolForWhatHasWaitedForAJobThatFails) {
  start();
  const auto submit_failing = [&](const char* executor) -> std::string {
    const ordered_json parameters{{"restitution", 0.5}, {"duration_s", 0.1}, {"run_up_s", 0.05}};
    return service_->submit_sweep({{"parameters", parameters}, {"executor", executor}}).at("id");
  };
  const std::string there = submit_failing("slurm");
  const auto batch = await_generation(0);
  const std::string here = submit_failing("local");
  const auto other =
      ordered_json::parse(R"({"parameters": {"duration_s": 0.1, "run_up_s": 0.05}, "executor": "local"})");
  // The local pool has looked at the job that waits, and has left it.
  ASSERT_TRUE(service_->wait_for_sweep(service_->submit_sweep(other).at("id"), 300s));
  EXPECT_EQ(counts(here).at("queued"), 1);
  compute(batch, 0);
  ASSERT_TRUE(service_->wait_for_sweep(there, 300s));
  EXPECT_TRUE(service_->wait_for_sweep(here, 20s));
  EXPECT_EQ(counts(here).at("failed"), 1);
}

TEST_F(ClusterTest, TellsThatJobsBegin) {
  start();
  const std::string id = submit(2);
  const auto batch = await_generation(0);
  const std::uint64_t before = service_->activity();
  report_all(batch, 1, "RUNNING");
  wait_until([&] { return counts(id).at("running") == 2; }, "jobs run");
  wait_until([&] { return service_->activity() > before; }, "it is told");
}

TEST_F(ClusterTest, NamesNodeAndNumericsInEachResult) {
  start();
  const std::string id = submit(1);
  compute(await_generation(0), 0);
  ASSERT_TRUE(service_->wait_for_sweep(id, 300s));
  const auto job = service_->find_job(service_->find_results(id)->rows.at(0).at(0)).value();
  EXPECT_THAT(job.at("run").at("libm").get<std::string>(), HasSubstr("glibc"));
  EXPECT_EQ(job.at("run").at("numerics"), "native");
  EXPECT_EQ(job.at("attempts"), 1);
}

TEST_F(ClusterTest, DoesNotSubmitAgainWhatSlurmHasAlthoughItSaidSocketTimedOut) {
  fake_.answer("sbatch", "echo 'sbatch: error: Socket timed out on send/recv operation' >&2; exit 1");
  start();
  const std::string id = submit(2);
  const auto batch = await_generation(0);
  report_all(batch, 1, "RUNNING");
  wait_until([&] { return counts(id).at("running") == 2; }, "the tasks are known to run");
  std::this_thread::sleep_for(300ms);  // three times what a lost task is given
  EXPECT_EQ(fake_.count("sbatch"), 1);
  compute(batch, 0);
  EXPECT_TRUE(service_->wait_for_sweep(id, 300s));
}

TEST_F(ClusterTest, ShowsWhatSbatchRefusesAndTriesAgainOnlyLater) {
  fake_.answer("sbatch", "echo 'sbatch: error: QOSMaxSubmitJobPerUserLimit' >&2; exit 1");
  fake_.report("");
  start();
  const std::string id = submit(2);
  wait_until(
      [&] { return status().at("problems").dump().find("QOSMaxSubmitJobPerUserLimit") != std::string::npos; },
      "the problem is shown");
  std::this_thread::sleep_for(400ms);
  EXPECT_EQ(fake_.count("sbatch"), 1);  // the first pause is 30 s
  EXPECT_EQ(counts(id).at("queued"), 2);
}

TEST_F(ClusterTest, GivesVanishedTasksToANewArray) {
  start();
  const std::string id = submit(2);
  const auto batch = await_generation(0);
  report_all(batch, 1, "RUNNING");
  wait_until([&] { return counts(id).at("running") == 2; }, "tasks run");
  fake_.report("");  // the controller has lost them
  EXPECT_EQ(await_generation(1), batch);
  wait_until([&] { return counts(id).at("queued") == 2; }, "they wait again");
  compute(batch, 1);
  EXPECT_TRUE(service_->wait_for_sweep(id, 300s));
}

struct Mute {
  std::string name, script;
};
class MuteSqueue : public ClusterTest, public testing::WithParamInterface<Mute> {};

TEST_P(MuteSqueue, LeadsToNoConclusion) {
  fake_.answer("squeue", GetParam().script);
  auto all = options();
  all.site.query_deadline = 50ms;
  service_.emplace(all);
  const std::string id = submit(2);
  const auto batch = await_generation(0);
  wait_until([&] { return !status().at("problems").empty(); }, "the problem is shown");
  std::this_thread::sleep_for(400ms);
  EXPECT_EQ(fake_.count("sbatch"), 1);
  compute(batch, 0);  // results count all the same
  EXPECT_TRUE(service_->wait_for_sweep(id, 300s));
}

INSTANTIATE_TEST_SUITE_P(Ways, MuteSqueue,
                         testing::Values(Mute{"Fails", "exit 1"}, Mute{"Hangs", "sleep 100"},
                                         Mute{"TalksNonsense", "echo nonsense"}),
                         [](const auto& each) { return each.param.name; });

TEST_F(ClusterTest, TakesResultsThatCameWhileTheServiceWasAway) {
  start();
  const std::string id = submit(3);
  const auto batch = await_generation(0);
  service_.reset();
  EXPECT_EQ(fake_.count("scancel"), 0);  // tasks go on
  compute(batch, 0);
  start();
  ASSERT_TRUE(service_->wait_for_sweep(id, 300s));
  EXPECT_EQ(counts(id).at("succeeded"), 3);
  EXPECT_EQ(fake_.count("sbatch"), 1);
}

TEST_F(ClusterTest, ComputesDamagedResultsAgain) {
  start();
  const std::string id = submit(1);
  const auto batch = await_generation(0);
  std::ofstream(batch / "out" / "g0-0-n1-1-0.results") << "RPSUPRS1, or so";
  report_all(batch, 1, "COMPLETED");
  compute(await_generation(1), 1);
  EXPECT_TRUE(service_->wait_for_sweep(id, 300s));
}

TEST_F(ClusterTest, EndsTheTasksOfACancelledSweepAndTakesNoMoreOfTheirResults) {
  start();
  const std::string id = submit(2);
  const auto batch = await_generation(0);
  report_all(batch, 1, "PENDING", "Resources");
  wait_until([&] { return status().at("tasks").at("pending") > 0; }, "tasks wait");
  service_->cancel_sweep(id);
  EXPECT_EQ(counts(id).at("cancelled"), 2);
  wait_until([&] { return fake_.count("scancel") > 0; }, "scancel is called");
  EXPECT_TRUE(std::filesystem::exists(batch / "CANCEL"));
  fake_.report("");
  wait_until([&] { return !std::filesystem::exists(batch); }, "the folder is removed");
  EXPECT_EQ(counts(id).at("cancelled"), 2);
}

TEST_F(ClusterTest, MovesWhatWaitsToTheLocalPool) {
  start();
  const std::string id = submit(2);
  const auto batch = await_generation(0);
  report_all(batch, 1, "PENDING", "Resources");
  wait_until([&] { return status().at("tasks").at("pending") > 0; }, "tasks wait");
  EXPECT_EQ(service_->move_sweep(id, {{"executor", "local"}})->at("executor"), "local");
  ASSERT_TRUE(service_->wait_for_sweep(id, 300s));
  EXPECT_EQ(engine_.begun_speeds().size(), 2U);
  wait_until([&] { return fake_.count("scancel") > 0; }, "scancel is called");
  EXPECT_THROW(service_->move_sweep(id, {{"executor", "local"}}), jobs::WrongState);
  EXPECT_FALSE(service_->move_sweep("swp_none", {{"executor", "slurm"}}));
}

TEST_F(ClusterTest, FailsAJobThatNoTaskCanCompute) {
  start();
  const std::string id = submit(1);
  const auto batch = await_generation(0);
  report_all(batch, 3, "FAILED", "NonZeroExitCode");  // without a log: no fault of the task
  for (const int generation : {1, 2}) {
    const std::string name = "g" + std::to_string(generation) + "-0.log";
    std::ofstream(batch / "log" / name) << "Illegal instruction\n";
    await_generation(generation);
    report_all(batch, 3, "FAILED", "NonZeroExitCode");
  }
  ASSERT_TRUE(service_->wait_for_sweep(id, 300s));
  const auto job = service_->find_job(service_->find_results(id)->rows.at(0).at(0)).value();
  EXPECT_EQ(job.at("error").at("reason"), "task_failed");
  EXPECT_THAT(job.at("error").at("detail").get<std::string>(), HasSubstr("Illegal instruction"));
}

TEST_F(ClusterTest, LeavesASweepThatAsksForTheLocalPoolToIt) {
  start();
  const auto request =
      ordered_json::parse(R"({"parameters": {"duration_s": 0.1, "run_up_s": 0.05}, "executor": "local"})");
  EXPECT_TRUE(service_->wait_for_sweep(service_->submit_sweep(request).at("id"), 300s));
  EXPECT_EQ(fake_.count("sbatch"), 0);
}

TEST(Executors, AreRefusedWhereTheyAreNotThere) {
  TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  for (const char* const text :
       {R"({"executor": "slurm"})", R"({"executor": "moon"})", R"({"executor": 1})"}) {
    try {
      service.submit_sweep(ordered_json::parse(text));
      ADD_FAILURE() << text << " was taken";
    } catch (const jobs::InvalidRequest& error) {
      EXPECT_EQ(error.faults().at(0).pointer, "/executor");
    }
  }
  const std::string id = service.submit_sweep(ordered_json::object()).at("id");
  for (const char* const text :
       {R"({})", R"([])", R"({"executor": "slurm"})", R"({"executor": "local", "when": 1})"}) {
    EXPECT_THROW(service.move_sweep(id, nlohmann::json::parse(text)), jobs::InvalidRequest) << text;
  }
}

TEST_F(ClusterTest, PausesAfterARoundThatFails) {
  { const jobs::Service first(options_of(store_, engine_, 1)); }  // makes the store
  const auto folder = fake_.site().folder / query_sql(store_.file(), "SELECT id FROM identity");
  std::filesystem::create_directories(folder);
  const jobs::StoreLock held(folder);  // as by another service
  start();
  wait_until([&] { return !status().at("problems").empty(); }, "the problem is shown");
  int rounds = 0;  // each gives the folder to its owner alone
  for (int look = 0; look < 300; ++look) {
    if (std::filesystem::status(folder).permissions() == std::filesystem::perms(0700)) {
      ++rounds;
      std::filesystem::permissions(folder, std::filesystem::perms(0755));
    }
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_LT(rounds, 20);  // pauses grow from 1 s on
}

TEST_F(ClusterTest, LeavesBatchesOfAnotherEngineToNobody) {
  start();
  const std::string id = submit(1);
  await_generation(0);
  service_.reset();
  execute_sql(store_.file(), "UPDATE batches SET engine_version = 'of yesterday'");
  fake_.report("");
  start();
  compute(await_generation(1), 0);  // a new batch
  EXPECT_TRUE(service_->wait_for_sweep(id, 300s));
}

}  // namespace
}  // namespace jobs_tests
