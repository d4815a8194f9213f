// SPDX-License-Identifier: Apache-2.0
// Sweeps that are extended, tried again, sent again and watched.

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "jobs/exports/write_trajectories.h"
#include "jobs/store/store.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using Strings = std::vector<std::string>;

json await(const jobs::Service& service, const std::string& id) {
  EXPECT_TRUE(service.wait_for_sweep(id, seconds(300)));
  return service.find_sweep(id).value();
}

std::string submit(jobs::Service& service, const char* request) {
  return service.submit_sweep(request_of(request)).at("id");
}

TEST(Retry, QueuesFailedAndCancelledJobsOnly) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string id = submit(service, R"({"sweep": {"restitution": [0.9, 0.5, 0.4]}})");
  json sweep = await(service, id);
  EXPECT_EQ(sweep.at("counts").at("failed"), 2);
  EXPECT_EQ(engine.begun_speeds().size(), 3U);
  const auto before = service.find_results(id).value().rows;

  const json again = service.retry_sweep(id).value();
  EXPECT_EQ(again.at("counts").at("succeeded"), 1);
  EXPECT_EQ(again.at("counts").at("total"), 3);
  EXPECT_EQ(await(service, id).at("counts").at("failed"), 2);
  EXPECT_EQ(engine.begun_speeds().size(), 5U);
  EXPECT_EQ(service.find_job(before[1][0])->at("attempts"), 2);
  EXPECT_EQ(service.find_job(before[0][0])->at("attempts"), 1);
  EXPECT_FALSE(service.retry_sweep("swp_none").has_value());
}

TEST(Retry, BringsACancelledSweepToItsEnd) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 2));
  engine.hold();
  const std::string id = submit(service, R"({"sweep": {"crank_velocity_rad_s": [5, 6, 7, 8]}})");
  engine.await_running(2);
  service.cancel_sweep(id);
  engine.release();
  service.retry_sweep(id);
  const json sweep = await(service, id);
  EXPECT_EQ(sweep.at("state"), "succeeded");
  EXPECT_EQ(sweep.at("counts").at("succeeded"), 4);
}

TEST(Retry, UsesAResultThatHasBecomeKnown) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  engine.hold();
  const std::string first = submit(service, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  engine.await_running(1);
  service.cancel_sweep(first);
  engine.release();
  await(service, submit(service, R"({"name": "other", "sweep": {"crank_velocity_rad_s": [5]}})"));
  const auto runs = engine.begun_speeds().size();
  EXPECT_EQ(service.retry_sweep(first)->at("state"), "succeeded");
  EXPECT_EQ(engine.begun_speeds().size(), runs);
}

TEST(Retry, ComputesWithTheEngineOfToday) {
  const TemporaryStore temporary;
  std::string id;
  {
    jobs::Store store(temporary.file());
    id = store.queue.add_sweep(
        jobs::plan_sweep(request_of(R"({"sweep": {"crank_velocity_rad_s": [5]}})"), 10), "{}", 10);
    static_cast<void>(store.queue.cancel_sweep(id));
  }
  const std::string name = query_sql(temporary.file(), "SELECT content_id FROM contents");
  execute_sql(temporary.file(), "UPDATE contents SET content_id = 'old', engine_version = '0.0.1'");
  {
    jobs::Store store(temporary.file());
    EXPECT_TRUE(store.queue.retry_sweep(id, 10));
  }
  EXPECT_EQ(
      query_sql(temporary.file(), "SELECT c.content_id FROM jobs j JOIN contents c ON c.seq = j.content"),
      name);
}

TEST(Again, SaysOnceThatTheStoreIsOfAnotherEngineAndComputesAnew) {
  const TemporaryStore temporary;
  FakeEngine engine;
  std::vector<std::string> said;
  jobs::ServiceOptions options = options_of(temporary, engine, 1);
  options.log = [&said](const std::string& message) { said.push_back(message); };
  const char* const request = R"({"sweep": {"crank_velocity_rad_s": [5]}})";
  {
    jobs::Service service(options);
    await(service, submit(service, request));
  }
  EXPECT_TRUE(said.empty()) << said.front();
  execute_sql(temporary.file(), "UPDATE contents SET content_id = 'old', engine_version = '0.1.0-other'");
  {
    jobs::Service service(options);
    await(service, submit(service, request));
  }
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said.front().find("0.1.0-other"), std::string::npos) << said.front();
  EXPECT_EQ(engine.begun_speeds().size(), 2U);
  jobs::Service service(options);
  EXPECT_EQ(said.size(), 1U) << said.back();
}

// The next end has a new number, also after retries and a restart: a client that knows the last end and asks
// for changes from there on is told of the next one.
TEST(Retry, ForgetsNoNumberOfAnEnd) {
  const TemporaryStore temporary;
  std::string id;
  std::int64_t last = 0;
  {
    jobs::Store store(temporary.file());
    id = store.queue.add_sweep(
        jobs::plan_sweep(request_of(R"({"sweep": {"crank_velocity_rad_s": [5]}})"), 10), "{}", 10);
    for (int times = 0; times < 3; ++times) {
      static_cast<void>(store.queue.cancel_sweep(id));
      last = store.reader.find_changes(id, 0)->ended.at(0).change;
      EXPECT_TRUE(store.queue.retry_sweep(id, 10));
    }
    EXPECT_TRUE(store.reader.find_changes(id, 0)->ended.empty());
    EXPECT_EQ(store.reader.find_results(id)->rows.at(0).change, 0);
  }
  jobs::Store store(temporary.file());
  static_cast<void>(store.queue.cancel_sweep(id));
  EXPECT_EQ(store.reader.find_changes(id, last)->ended.size(), 1U);
}

// A crash leaves the state either before the retry or after it.
TEST(Retry, OpensTheStudyOfASweepInOneStep) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const auto plan = jobs::plan_sweep(request_of(R"({"sweep": {"crank_velocity_rad_s": [5, 6]}})"), 10);
  const std::string search = store.studies.add("sch_", plan, "{}", "{}", 10);
  const std::string sweep = store.studies.find(search)->sweep_id;
  static_cast<void>(store.queue.cancel_sweep(sweep));
  EXPECT_TRUE(store.studies.set_state(search, "running", "failed", "why"));
  EXPECT_THROW((void)store.queue.retry_sweep(sweep, 1), jobs::QueueFull);
  EXPECT_EQ(store.studies.find(search)->state, "failed");
  EXPECT_TRUE(store.queue.retry_sweep(sweep, 10));
  EXPECT_EQ(store.studies.find(search)->state, "running");
  EXPECT_FALSE(store.studies.find(search)->error.has_value());
  EXPECT_TRUE(store.studies.set_state(search, "running", "failed", "why"));
  EXPECT_TRUE(store.queue.retry_sweep(sweep, 10));
  EXPECT_EQ(store.studies.find(search)->state, "running") << "though no job is tried again";
}

TEST(Retry, StopsTheAttemptThatRunsWhenAnEarlierOneHasNotEnded) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 2));
  engine.hold();
  const std::string id = submit(service, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  engine.await_running(1);
  for (int times = 0; times < 20; ++times) {
    service.cancel_sweep(id);
    service.retry_sweep(id);
  }
  service.cancel_sweep(id);
  engine.await_running(0);  // throws if one of them goes on
}

TEST(Extend, RunsNewJobsOnlyAndReadsAsTheUnion) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string id = submit(service, R"({"sweep": {"crank_velocity_rad_s": [5, 6]}})");
  await(service, id);
  const auto before = service.find_results(id).value().rows;
  service.extend_sweep(id, request_of(R"({"sweep": {"crank_velocity_rad_s": [7, 6]}})"));
  const json sweep = await(service, id);
  EXPECT_EQ(sweep.at("counts").at("succeeded"), 3);
  EXPECT_EQ(sweep.at("request"), json_of(R"({"sweep": {"crank_velocity_rad_s": [5, 6, 7]}})"));
  EXPECT_EQ(engine.begun_speeds(), (std::vector<double>{5, 6, 7}));
  const auto after = service.find_results(id).value().rows;
  ASSERT_EQ(after.size(), 3U);
  EXPECT_EQ(after[0], before[0]);
  EXPECT_EQ(after[2][2], 7.0);
  // The same again changes nothing; what is faulty is refused; another sweep has nothing of it.
  EXPECT_EQ(service.extend_sweep(id, request_of(R"({"sweep": {"crank_velocity_rad_s": [7]}})"))
                ->at("counts")
                .at("total"),
            3);
  EXPECT_EQ(pointers_of(faults_of(
                [&] { service.extend_sweep(id, request_of(R"({"sweep": {"restitution": [0.8]}})")); })),
            (Strings{"/sweep/restitution"}));
  EXPECT_FALSE(service.extend_sweep("swp_none", request_of("{}")).has_value());
}

TEST(Extend, TakesTwoAtATime) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string id = submit(service, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  const auto extend_from = [&](int first) {
    for (int k = first; k < first + 10; ++k) {
      service.extend_sweep(id, {{"sweep", {{"crank_velocity_rad_s", {k}}}}});
    }
  };
  {
    std::jthread one(extend_from, 10);
    std::jthread other(extend_from, 20);
  }
  const json sweep = await(service, id);
  EXPECT_EQ(sweep.at("counts").at("succeeded"), 21);
  EXPECT_EQ(sweep.at("request").at("sweep").at("crank_velocity_rad_s").size(), 21U);
}

TEST(Idempotency, AnswersTheSameRequestAsBefore) {
  const TemporaryStore temporary;
  FakeEngine engine;
  const auto request = request_of(R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  std::string first;
  {
    jobs::Service service(options_of(temporary, engine, 1));
    first = service.submit_sweep(request, "key").dump();
    await(service, json_of(first).at("id"));
    EXPECT_EQ(service.submit_sweep(request, "key").dump(), first);
    EXPECT_NE(service.submit_sweep(request, "other key").dump(), first);
    EXPECT_NE(service.submit_sweep(request).dump(), first);
  }
  jobs::Service service(options_of(temporary, engine, 1));  // it is in the store
  EXPECT_EQ(service.submit_sweep(request, "key").dump(), first);
  EXPECT_EQ(service.list_sweeps({}).at("items").size(), 3U);
}

// A row that is read after the commit may have been deleted in between, and reading may fail.
TEST(Idempotency, MakesTheAnswerInOneStepWithWhatItAnswersWithoutAKeyToo) {
  const TemporaryStore temporary;
  std::vector<std::string> made;
  const auto note = [&](const auto& row) {
    made.push_back(row.id);
    return std::string();
  };
  const auto note_study = [&](const jobs::StudySnapshot& begun) { return note(begun.study); };
  const auto plan = jobs::plan_sweep(request_of("{}"), 10);
  const jobs::PackedMeasurement measured{.name = "rig", .description = "{}", .samples = "none"};
  {
    jobs::Store store(temporary.file());
    const std::vector<std::string> ids{
        store.queue.add_sweep(plan, "{}", 10, {.key = {}, .fingerprint = {}, .make_response = note}),
        store.queue.add_job(plan.jobs.at(0), 10, {.key = {}, .fingerprint = {}, .make_response = note}),
        store.studies.add("sch_", plan, "{}", "{}", 10,
                          {.key = {}, .fingerprint = {}, .make_response = note_study}),
        store.measurements.add(measured, {.key = {}, .fingerprint = {}, .make_response = note})};
    EXPECT_EQ(made, ids);
  }
  EXPECT_EQ(query_sql(temporary.file(), "SELECT count(*) FROM answers"), "0");
}

TEST(Idempotency, RefusesAKeyOfAnotherRequest) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string job = service.submit_job(json::object(), "key").dump();
  EXPECT_EQ(service.submit_job(json::object(), "key").dump(), job);
  EXPECT_THROW((void)service.submit_job({{"clearance_mm", 0.5}}, "key"), jobs::InvalidRequest);
  // the same text, but to another route
  EXPECT_THROW((void)service.submit_sweep(request_of("{}"), "key"), jobs::InvalidRequest);
  EXPECT_EQ(service.list_jobs({}).at("items").size(), 1U);
}

TEST(Idempotency, KeepsNoKeyOfWhatWasRefused) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  EXPECT_THROW((void)service.submit_job({{"clearance_mm", -1}}, "key"), jobs::InvalidRequest);
  EXPECT_NO_THROW((void)service.submit_job({{"clearance_mm", 0.1}}, "key"));
}

TEST(Idempotency, StoresOneSweepOfManyRequestsAtATime) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const auto request =
      request_of(R"({"sweep": {"crank_velocity_rad_s": {"from": 5, "to": 6, "count": 500}}})");
  std::mutex mutex;
  std::set<std::string> answers;
  int in_flight = 0;
  {
    std::vector<std::jthread> clients;
    for (int k = 0; k < 8; ++k) {
      clients.emplace_back([&] {
        try {
          const std::string answer = service.submit_sweep(request, "key").dump();
          const std::lock_guard lock(mutex);
          answers.insert(answer);
        } catch (const jobs::WrongState&) {
          const std::lock_guard lock(mutex);
          ++in_flight;
        }
      });
    }
  }
  EXPECT_EQ(answers.size(), 1U);
  EXPECT_EQ(service.list_sweeps({}).at("items").size(), 1U);
  RecordProperty("refused_in_flight", in_flight);
}

TEST(Idempotency, ForgetsAfterAWeek) {
  const TemporaryStore temporary;
  FakeEngine engine;
  std::string first;
  {
    jobs::Service service(options_of(temporary, engine, 1));
    first = service.submit_job(json::object(), "key").dump();
  }
  execute_sql(temporary.file(), "UPDATE answers SET created_ms = created_ms - 7 * 24 * 3600 * 1000");
  jobs::Service service(options_of(temporary, engine, 1));
  EXPECT_NE(service.submit_job(json::object(), "key").dump(), first);
}

// The times are moved in the place of the clock.
TEST(Idempotency, OutlivesAClockThatIsAheadForOneRequest) {
  const TemporaryStore temporary;
  FakeEngine engine;
  const auto submit_once = [&](const char* key) {
    jobs::Service service(options_of(temporary, engine, 1));
    return service.submit_job(json::object(), key).dump();
  };
  const std::string first = submit_once("key");
  execute_sql(temporary.file(), "UPDATE answers SET created_ms = created_ms - 8 * 24 * 3600 * 1000");
  submit_once("other key");
  execute_sql(temporary.file(), "UPDATE answers SET created_ms = created_ms + 8 * 24 * 3600 * 1000");
  EXPECT_EQ(submit_once("key"), first);
}

TEST(Priority, ComesBeforeTurns) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  engine.hold();
  submit(service, R"({"sweep": {"crank_velocity_rad_s": [5, 6, 7]}})");
  engine.await_running(1);
  const std::string low = submit(service, R"({"priority": -1, "sweep": {"crank_velocity_rad_s": [8]}})");
  const std::string high = submit(service, R"({"priority": 1, "sweep": {"crank_velocity_rad_s": [9, 10]}})");
  EXPECT_EQ(service.find_sweep(high)->at("priority"), 1);
  engine.release();
  await(service, low);
  EXPECT_EQ(engine.begun_speeds(), (std::vector<double>{5, 9, 10, 6, 7, 8}));
}

TEST(News, TellOfEachJobOnceInTheOrderOfTheEnds) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const auto quiet = service.activity();
  const std::string id = submit(service, R"({"sweep": {"restitution": [0.9, 0.5, 0.8]}})");
  await(service, id);
  EXPECT_GT(service.activity(), quiet);
  const auto all = service.find_news(id, 0).value();
  EXPECT_TRUE(all.ended);
  EXPECT_EQ(all.progress.at("progress"), 1.0);
  ASSERT_EQ(all.jobs.size(), 3U);
  EXPECT_LT(all.jobs[0].change, all.jobs[1].change);
  EXPECT_EQ(all.jobs[1].job.at("error_reason"), "non_finite");
  const auto rest = service.find_news(id, all.jobs[1].change).value();
  ASSERT_EQ(rest.jobs.size(), 1U);
  EXPECT_EQ(rest.jobs[0].job, all.jobs[2].job);
  service.retry_sweep(id);
  await(service, id);
  const auto again = service.find_news(id, all.jobs[2].change).value();
  ASSERT_EQ(again.jobs.size(), 1U);
  EXPECT_EQ(again.jobs[0].job.at("job_id"), all.jobs[1].job.at("job_id"));
  EXPECT_FALSE(service.find_news("swp_none", 0).has_value());
}

TEST(FileOfTrajectories, LeavesTheReserveOfTheDisk) {
  const TemporaryStore temporary;
  FakeEngine engine;
  const auto folder = temporary.file().parent_path();
  const jobs::TrajectoryExport npz{.format = jobs::TrajectoryFileFormat::kNpz};
  auto options = options_of(temporary, engine, 1);
  std::string id;
  {
    jobs::Service service(options);
    id = submit(service, R"({"sweep": {"crank_velocity_rad_s": [5, 6]}})");
    await(service, id);
    EXPECT_TRUE(service.write_trajectories(id, npz, folder / "first.npz"));
  }
  options.store_quota.reserve_bytes = static_cast<std::int64_t>(std::filesystem::space(folder).capacity) + 1;
  const jobs::Service service(options);
  EXPECT_THROW((void)service.write_trajectories(id, npz, folder / "second.npz"), jobs::StoreLimitReached);
  EXPECT_FALSE(std::filesystem::exists(folder / "second.npz"));
}

TEST(FileOfTrajectories, HasThoseOfRunsThatFailed) {
  const TemporaryStore temporary;
  FakeEngine engine;
  const auto file = temporary.file().parent_path() / "all.npz";
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string id = submit(service, R"({"sweep": {"restitution": [0.5]}})");
  await(service, id);
  const std::string job = first_job(service, id);
  ASSERT_EQ(service.find_job(job)->at("state"), "failed");
  EXPECT_TRUE(service.write_trajectories(id, {.format = jobs::TrajectoryFileFormat::kNpz}, file));
  std::ifstream written(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(written), {}};
  EXPECT_NE(bytes.find("trajectories/job_0001/t_s"), std::string::npos);
}

TEST(CopyOfTheStore, IsAStoreWithAllOfIt) {
  const TemporaryStore temporary;
  FakeEngine engine;
  const auto copy = temporary.file().parent_path() / "copy.db";
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string id = submit(service, R"({"sweep": {"crank_velocity_rad_s": [5, 6]}})");
  await(service, id);
  EXPECT_TRUE(service.copy_store_to(copy));
  EXPECT_THROW((void)service.copy_store_to(copy), jobs::StorageError);  // never over a file that is there
  EXPECT_EQ(std::filesystem::status(copy).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  auto options = options_of(temporary, engine, 1);
  options.store = copy;
  const jobs::Service other(options);
  EXPECT_EQ(other.find_sweep(id), service.find_sweep(id));
  EXPECT_EQ(other.find_results(id)->rows, service.find_results(id)->rows);
}

TEST(CopyOfTheStore, EndsWhenItIsToldTo) {
  const TemporaryStore temporary;
  FakeEngine engine;
  const auto copy = temporary.file().parent_path() / "copy.db";
  {
    jobs::Service service(options_of(temporary, engine, 1));
    await(service,
          submit(service, R"({"sweep": {"crank_velocity_rad_s": {"from": 5, "to": 6, "count": 1000}}})"));
  }
  EXPECT_FALSE(jobs::copy_store(temporary.file(), copy, [] { return true; }));
  EXPECT_FALSE(std::filesystem::exists(copy));
}

TEST(Results, ShowParametersThatAreNotSwept) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string id =
      submit(service, R"({"parameters": {"restitution": 0.8}, "sweep": {"crank_velocity_rad_s": [5, 6]}})");
  await(service, id);
  const auto table = service
                         .find_results(id, {.fields = "crank_velocity_rad_s,restitution,links.1,3.mass_kg",
                                            .filters = {{"restitution_gt", "0.7"}},
                                            .order_by = "-crank_velocity_rad_s",
                                            .limit = 1})
                         .value();
  EXPECT_EQ(table.columns, (Strings{"crank_velocity_rad_s", "restitution", "links.1,3.mass_kg"}));
  EXPECT_EQ(table.rows, (std::vector<std::vector<json>>{{6.0, 0.8, 0.306}}));
  EXPECT_TRUE(table.ended);
  EXPECT_TRUE(
      service
          .find_results(id, {.fields = {}, .filters = {{"restitution", "0.9"}}, .order_by = {}, .limit = {}})
          ->rows.empty());
}

TEST(Listings, ShowTheFieldsThatAreWanted) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string id = submit(service, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  jobs::PageQuery query;
  query.fields = "state,id";
  await(service, id);
  EXPECT_EQ(service.list_sweeps(query).at("items"), json::array({{{"id", id}, {"state", "succeeded"}}}));
  query.fields = "sweep_id,replicate";
  EXPECT_EQ(service.list_jobs(query).at("items"), json::array({{{"sweep_id", id}, {"replicate", nullptr}}}));
  query.fields = "id,nonsense";
  EXPECT_EQ(pointers_of(faults_of([&] { (void)service.list_sweeps(query); })), (Strings{"/fields/1"}));
}

}  // namespace
}  // namespace jobs_tests
