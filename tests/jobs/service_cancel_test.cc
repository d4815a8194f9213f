// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/service.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

TEST(Service, CancelsQueuedAndRunningJobsOfASweep) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 2));
  const std::string id = submitted(service, R"({"sweep": {"crank_velocity_rad_s": [1, 2, 3, 4]}})");
  engine.await_running(2);
  EXPECT_EQ(service.cancel_sweep(id).value().at("state"), "cancelled");
  engine.await_running(0);  // they are held: only what is stopped ends
  EXPECT_EQ(engine.stopped(), 2);
  EXPECT_EQ(service.cancel_sweep(id).value().at("state"), "cancelled");
  EXPECT_EQ(service.find_sweep(id).value().at("counts").at("cancelled"), 4);
  EXPECT_EQ(service.find_job(first_job(service, id)).value().at("state"), "cancelled");
  EXPECT_FALSE(service.cancel_sweep("swp_none").has_value());
}

TEST(Service, CancelsOneJobAndLeavesTheOthers) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 1));
  const std::string id = submitted(service, R"({"sweep": {"crank_velocity_rad_s": [1, 2, 3]}})");
  engine.await_running(1);
  const auto rows = service.find_results(id).value().rows;
  EXPECT_EQ(service.cancel_job(rows[0][0]).value().at("state"), "cancelled");  // running
  EXPECT_EQ(service.cancel_job(rows[2][0]).value().at("state"), "cancelled");  // queued
  engine.release();
  EXPECT_EQ(finished(service, id).at("counts").at("succeeded"), 1);
  EXPECT_THROW((void)service.cancel_job(rows[1][0]), jobs::WrongState);
  EXPECT_FALSE(service.cancel_job("job_none").has_value());
}

TEST(Service, RefusesToCancelWhatHasEnded) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const std::string id = submitted(service, "{}");
  finished(service, id);
  EXPECT_THROW((void)service.cancel_sweep(id), jobs::WrongState);
}

TEST(Service, RunsWhatWaitedForACancelledJob) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 1));
  const std::string first = submitted(service, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  engine.await_running(1);
  const std::string second = submitted(service, R"({"sweep": {"crank_velocity_rad_s": [5]}})");
  (void)service.cancel_sweep(first);
  engine.release();
  EXPECT_EQ(finished(service, second).at("state"), "succeeded");
}

// The thread of a cancelled job may take a while to stop. A job that waited for it starts beside it, on a
// free thread.
TEST(Service, WakesAFreeThreadForWhatWaitedForACancelledJob) {
  const TemporaryStore store;
  FakeEngine engine;
  std::promise<void> second_began;
  auto second = second_began.get_future().share();
  std::atomic<int> begun = 0;
  std::atomic<bool> beside = false;
  jobs::ServiceOptions options = options_of(store, engine, 2);
  options.runner = [&, fake = engine.runner()](const jobs::JobSpec& spec, const engine::StopQuery& stop) {
    if (begun++ == 0) {
      begun.notify_all();
      beside = second.wait_for(60s) == std::future_status::ready;
    } else {
      second_began.set_value();
    }
    return fake(spec, stop);
  };
  jobs::Service service(options);
  const std::string first = submitted(service, "{}");
  begun.wait(0);
  const std::string waiting = submitted(service, "{}");
  std::this_thread::sleep_for(50ms);  // for the free thread to find that it has to wait
  (void)service.cancel_sweep(first);
  EXPECT_EQ(finished(service, waiting).at("state"), "succeeded");
  service.stop();
  EXPECT_TRUE(beside);
}

TEST(Service, CancelsAndEndsWithoutHavingComputed) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::ServiceOptions options = options_of(store, engine, 2);
  options.start = jobs::Start::kWhenTold;
  jobs::Service service(options);
  const std::string id =
      service.submit_sweep(json::parse(R"({"sweep": {"crank_velocity_rad_s": [5, 6, 7]}})")).at("id");
  EXPECT_EQ(service.cancel_sweep(id).value().at("state"), "cancelled");
  service.stop();
  EXPECT_TRUE(engine.begun_speeds().empty());
}

}  // namespace
}  // namespace jobs_tests
