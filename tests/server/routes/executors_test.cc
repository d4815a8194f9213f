// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/context/metrics.h"
#include "tests/server/service_fixture.h"

namespace {

using nlohmann::json;
using server_tests::Bench;

TEST(Executors, AreListedWithWhatTheyDo) {
  Bench bench;
  const auto answer = bench.call("GET", "/v1/executors");
  EXPECT_EQ(answer.status, 200);
  const json items = json::parse(answer.body).at("items");
  ASSERT_EQ(items.size(), 1U);
  EXPECT_EQ(items[0].at("name"), "local");
  EXPECT_EQ(items[0].at("slots"), 1);
  EXPECT_TRUE(items[0].at("tasks").is_null());
  EXPECT_EQ(items[0].at("problems"), json::array());
  EXPECT_EQ(bench.call("GET", "/v1/executors", "", {{"name", "local"}}).status, 422);
}

TEST(Executors, TakeASweepThatIsMovedToThem) {
  Bench bench(server_tests::endless_run);
  const std::string path = "/v1/sweeps/" + bench.submit(R"({"executor": "local"})");
  const auto moved = bench.call("POST", path + "/move", R"({"executor": "local"})");
  EXPECT_EQ(moved.status, 200);
  EXPECT_EQ(json::parse(moved.body).at("executor"), "local");
  const auto refused = bench.call("POST", path + "/move", R"({"executor": "slurm"})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(json::parse(refused.body).at("errors").at(0).at("pointer"), "/executor");
  EXPECT_EQ(bench.call("POST", path + "/move", R"({"executor": "moon", "soon": true})").status, 422);
  EXPECT_EQ(bench.call("POST", path + "/move", "").status, 400);
  EXPECT_EQ(bench.call("POST", "/v1/sweeps/swp_none/move", R"({"executor": "local"})").status, 404);
  bench.call("POST", path + "/cancel");
  EXPECT_EQ(bench.call("POST", path + "/move", R"({"executor": "local"})").status, 409);
}

TEST(Executors, StandInTheMetrics) {
  const json cluster{{"name", "slurm"},
                     {"slots", 64},
                     {"tasks", {{"pending", 3}, {"running", 2}}},
                     {"nodes", {"n1", "n2"}},
                     {"problems", {"held"}}};
  const std::string text = server::Metrics().text({}, {{"items", {cluster}}});
  for (const char* const line :
       {"rpsup_executor_slots{executor=\"slurm\"} 64",
        "rpsup_executor_tasks{executor=\"slurm\",state=\"pending\"} 3",
        "rpsup_executor_tasks{executor=\"slurm\",state=\"running\"} 2",
        "rpsup_executor_nodes{executor=\"slurm\"} 2", "rpsup_executor_problems{executor=\"slurm\"} 1"}) {
    EXPECT_NE(text.find(std::string("\n") + line + "\n"), std::string::npos) << line << "\n" << text;
  }
}

}  // namespace
