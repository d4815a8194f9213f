#include "server/metrics.h"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/server/service_fixture.h"

namespace {

using server::Metrics;
using server_tests::Bench;

/// Whether a line of the text is this.
bool has_line(const std::string& text, const std::string& line) { return ("\n" + text).find("\n" + line + "\n") != std::string::npos; }

TEST(Metrics, CountRunsByKindAndFailuresByReason) {
  Metrics metrics;
  enum class What { kSucceeds, kFails, kThrows, kIsStopped } what = What::kSucceeds;
  const auto runner = metrics.measured([&](const jobs::JobSpec& spec, const engine::StopQuery& stop) {
    if (what == What::kThrows) throw std::runtime_error("thrown");
    engine::RunResult result = server_tests::known_run(spec, stop);
    if (what == What::kFails) result.status = engine::RunStatus::kNonFinite;
    if (what == What::kIsStopped) result.status = engine::RunStatus::kStopped;
    return result;
  });
  const auto never = [](double) { return false; };
  jobs::JobSpec flexible;
  flexible.parameters.coupler = engine::Coupler::kFlexible;
  static_cast<void>(runner(flexible, never));
  jobs::JobSpec bent;
  bent.parameters.rod.model = engine::LinkModel::kFlexible;
  static_cast<void>(runner(bent, never));
  static_cast<void>(runner({}, never));
  what = What::kFails;
  EXPECT_EQ(runner({}, never).status, engine::RunStatus::kNonFinite);
  what = What::kIsStopped;
  static_cast<void>(runner({}, never));
  what = What::kThrows;
  EXPECT_THROW(static_cast<void>(runner({}, never)), std::runtime_error);
  const std::string text = metrics.text({});
  EXPECT_TRUE(has_line(text, "rpsup_job_duration_seconds_count{kind=\"flexible\"} 2")) << text;
  EXPECT_TRUE(has_line(text, "rpsup_job_duration_seconds_count{kind=\"rigid\"} 2")) << text;
  EXPECT_TRUE(has_line(text, "rpsup_job_failures_total{reason=\"non_finite\"} 1")) << text;
  EXPECT_TRUE(has_line(text, "rpsup_job_failures_total{reason=\"internal\"} 1")) << text;
}

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
    return has_line(response.body, "rpsup_http_request_duration_seconds_count{" + labels + "} " + std::to_string(n));
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
