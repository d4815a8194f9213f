// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/table_json.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using nlohmann::json;

TEST(JsonRows, HaveEveryColumnInEveryRow) {
  const double third = 1.0 / 3.0;
  const jobs::ResultTable table{{"job_id", "clearance_mm", "peak"},
                                {{"j\"1", 0.25, third}, {"j2", 0, nullptr}}};
  const json rows = json::parse(jobs::to_json_rows(table));
  EXPECT_EQ(rows, json::parse(R"([{"job_id": "j\"1", "clearance_mm": 0.25, "peak": 0.3333333333333333},
                                  {"job_id": "j2", "clearance_mm": 0, "peak": null}])"));
}

TEST(JsonRows, EndWithTheStatisticsOfReplicates) {
  jobs::ResultTable table{{"job_id"}, {{"j1"}, {"j2"}}};
  table.replicates = {{.count = 2, .mean = 1.5, .spread = 0.5, .min = 1.0, .max = 2.0},
                      {.count = 0, .mean = {}, .spread = {}, .min = {}, .max = {}}};
  EXPECT_EQ(jobs::to_json_rows(table),
            "[\n{\"job_id\":\"j1\",\"replicates_count\":2,\"replicates_mean\":1.5,\"replicates_spread\":0.5,"
            "\"replicates_min\":1,\"replicates_max\":2},"
            "\n{\"job_id\":\"j2\",\"replicates_count\":0,\"replicates_mean\":null,\"replicates_spread\":null,"
            "\"replicates_min\":null,\"replicates_max\":null}\n]\n");
}

TEST(JsonRows, AreAnEmptyArrayForNoRows) {
  EXPECT_EQ(json::parse(jobs::to_json_rows({{"a"}, {}})), json::array());
}

TEST(JsonColumns, AreArraysByTheirKey) {
  engine::Trajectory trajectory;
  trajectory.channels = {{.key = "t_s", .help = ""}, {.key = "z_m", .help = ""}};
  trajectory.columns = {{0.0, 0.001}, {-2.5, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_EQ(
      json::parse(jobs::to_json_columns(trajectory)),
      json::parse(R"({"channels": ["t_s", "z_m"], "columns": {"t_s": [0, 0.001], "z_m": [-2.5, null]}})"));
}

TEST(JsonColumns, ReadWithoutAnyChannel) {
  EXPECT_EQ(json::parse(jobs::to_json_columns({})), json::parse(R"({"channels": [], "columns": {}})"));
}

TEST(JsonColumns, HoldNumbersThatReadBackExactly) {
  const std::vector<double> values{0.1, -1.0 / 3.0, 5e-324, 1.7976931348623157e308, 123456789.0, 0.0};
  engine::Trajectory trajectory;
  trajectory.channels = {{.key = "x", .help = ""}};
  trajectory.columns = {values};
  EXPECT_EQ(json::parse(jobs::to_json_columns(trajectory)).at("columns").at("x").get<std::vector<double>>(),
            values);
}

TEST(JsonColumns, AreNullWhereNumbersAreNotFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  engine::Trajectory trajectory;
  trajectory.channels = {{.key = "x", .help = ""}};
  trajectory.columns = {{std::numeric_limits<double>::quiet_NaN(), -kInfinity, kInfinity}};
  EXPECT_EQ(json::parse(jobs::to_json_columns(trajectory)).at("columns").at("x"),
            json::parse("[null, null, null]"));
}

TEST(JsonRows, EscapeAndReplaceWhatIsNoUtf8) {
  EXPECT_EQ(jobs::to_json_lines({{"a\"\n\xff"}, {{1}}}), "{\"a\\\"\\n\xef\xbf\xbd\":1}\n");
}

}  // namespace
