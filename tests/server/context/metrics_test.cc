// SPDX-License-Identifier: Apache-2.0
#include "server/context/metrics.h"

#include <chrono>
#include <new>
#include <ostream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "jobs/runs/run_record.h"
#include "tests/server/service_fixture.h"

namespace {

using server::Metrics;
using server_tests::Bench;

/// Whether a line of the text is this.
bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST(Metrics, CountRunsByKind) {
  Metrics metrics;
  jobs::RunRecord failed;
  failed.end = jobs::RunRecord::End::kFailed;
  failed.error_reason = "non_finite";
  failed.error_t_s = 0.1;
  jobs::RunRecord stopped;
  stopped.end = jobs::RunRecord::End::kStopped;
  jobs::JobSpec flexible;
  flexible.parameters.coupler = engine::Coupler::kFlexible;
  jobs::JobSpec bent;
  bent.parameters.rod.model = engine::LinkModel::kFlexible;
  jobs::JobSpec described = flexible;  // of which a described linkage has nothing
  described.linkage.emplace().bodies.emplace_back();
  jobs::JobSpec described_beam;
  described_beam.linkage.emplace().bodies.emplace_back().beam.emplace();
  for (const jobs::JobSpec& spec :
       {flexible, bent, described, described_beam, described_beam, jobs::JobSpec{}})
    metrics.add_run(spec, {});
  metrics.add_run({}, failed);
  metrics.add_run({}, stopped);
  const std::string text = metrics.text({});
  EXPECT_TRUE(has_line(text, "rpsup_job_duration_seconds_count{kind=\"flexible\"} 4")) << text;
  EXPECT_TRUE(has_line(text, "rpsup_job_duration_seconds_count{kind=\"rigid\"} 3")) << text;
  EXPECT_TRUE(has_line(text, "rpsup_job_failures_total{reason=\"non_finite\"} 1")) << text;
}

struct FailureCase {
  std::string name;
  jobs::Runner runner;
  jobs::JobLimits limits;
  std::string reason;
};
void PrintTo(const FailureCase& c, std::ostream* out) { *out << c.name; }

class Failures : public testing::TestWithParam<FailureCase> {};

TEST_P(Failures, AreCountedByTheReasonThatTheJobHas) {
  const server_tests::TemporaryFolder folder;
  Metrics metrics;
  jobs::ServiceOptions options;
  options.store = folder / "store.db";
  options.runner = GetParam().runner;
  options.job_limits = GetParam().limits;
  options.ran = [&](const jobs::JobSpec& spec, const jobs::RunRecord& run) { metrics.add_run(spec, run); };
  jobs::Service service(options);
  const std::string id =
      service.submit_sweep(nlohmann::ordered_json::parse(R"({"sweep": {"clearance_mm": [0.1]}})")).at("id");
  ASSERT_TRUE(service.wait_for_sweep(id, std::chrono::seconds(300)));
  EXPECT_EQ(service.list_jobs({}).at("items").at(0).at("error").at("reason"), GetParam().reason);
  const std::string text = metrics.text({});
  EXPECT_TRUE(has_line(text, "rpsup_job_failures_total{reason=\"" + GetParam().reason + "\"} 1")) << text;
}

jobs::Runner throwing(const auto& error) {
  return [error](const jobs::JobSpec&, const engine::StopQuery&) -> engine::RunResult { throw error; };
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Failures,
    testing::Values(FailureCase{"TimeLimit", server_tests::endless_run, {.wall_time_s = 0.05}, "time_limit"},
                    FailureCase{"TooLarge", server_tests::known_run, {.memory_bytes = 1000}, "memory_limit"},
                    FailureCase{"NoMemory", throwing(std::bad_alloc()), {}, "memory_limit"},
                    FailureCase{"Internal", throwing(std::runtime_error("thrown")), {}, "internal"}),
    [](const auto& case_info) { return case_info.param.name; });

TEST(Metrics, SayTheLoadAsItIsNow) {
  Metrics metrics;
  static_cast<void>(metrics.text({.queued = 5, .running = 1, .store_bytes = 10}));
  const std::string text = metrics.text({.queued = 3, .running = 2, .store_bytes = 8192});
  EXPECT_TRUE(has_line(text, "rpsup_jobs_queued 3")) << text;
  EXPECT_TRUE(has_line(text, "rpsup_jobs_running 2")) << text;
  EXPECT_TRUE(has_line(text, "rpsup_store_bytes 8192")) << text;
  EXPECT_NE(text.find("\nrpsup_build_info{"), std::string::npos);
}

TEST(MetricsRoute, CountsRequestsByRouteAndNotByPath) {
  Bench bench;
  const std::string id = bench.run(R"({"sweep": {"clearance_mm": [0.1, 0.2]}})");
  for (int i = 0; i < 3; ++i) static_cast<void>(bench.call("GET", "/v1/sweeps/" + id));
  static_cast<void>(bench.call("GET", "/v1/sweeps/none"));
  static_cast<void>(bench.call("GET", "/anything"));
  static_cast<void>(bench.call("BREW", "/v1/sweeps"));
  const auto response = bench.call("GET", "/metrics");
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.content_type, "text/plain; version=0.0.4; charset=utf-8");
  const auto count = [&](const std::string& labels, int n) {
    return has_line(response.body,
                    "rpsup_http_request_duration_seconds_count{" + labels + "} " + std::to_string(n));
  };
  EXPECT_TRUE(count(R"(method="GET",route="/v1/sweeps/{id}",status="200")", 3)) << response.body;
  EXPECT_TRUE(count(R"(method="GET",route="/v1/sweeps/{id}",status="404")", 1)) << response.body;
  EXPECT_TRUE(count(R"(method="GET",route="none",status="404")", 1)) << response.body;
  EXPECT_TRUE(count(R"(method="POST",route="/v1/sweeps",status="201")", 1)) << response.body;
  EXPECT_EQ(response.body.find("BREW"), std::string::npos);
  EXPECT_EQ(response.body.find(id), std::string::npos);
  EXPECT_TRUE(has_line(response.body, "rpsup_jobs_queued 0"));
  EXPECT_EQ(response.body.find("rpsup_store_bytes 0\n"), std::string::npos);
}

TEST(MetricsRoute, SeesWhatWaitsAndWhatRuns) {
  Bench bench(server_tests::endless_run);
  const std::string id = bench.submit(R"({"sweep": {"clearance_mm": [0.1, 0.2, 0.3]}})");
  const auto running = [&] { return has_line(bench.call("GET", "/metrics").body, "rpsup_jobs_running 1"); };
  for (int i = 0; i < 500 && !running(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(has_line(bench.call("GET", "/metrics").body, "rpsup_jobs_queued 2"));
  EXPECT_TRUE(running());
  static_cast<void>(bench.call("POST", "/v1/sweeps/" + id + "/cancel"));
}

}  // namespace
