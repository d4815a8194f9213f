// SPDX-License-Identifier: Apache-2.0
#include "server/routes/tables.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/analysis/quantities.h"

namespace {

using nlohmann::json;
using server::Request;
using server::TableFormat;

TableFormat format_of(const std::string& accept, const std::string& format) {
  Request request;
  request.accept = accept;
  if (!format.empty()) request.query = {{"format", format}};
  server::Query query(request, {"format"});
  const TableFormat result = server::find_row_format(request, query);
  query.check();
  return result;
}

TEST(FindFormat, TakesTheQueryBeforeTheHeader) {
  EXPECT_EQ(format_of("", ""), TableFormat::kJson);
  EXPECT_EQ(format_of("*/*", ""), TableFormat::kJson);
  EXPECT_EQ(format_of("text/csv", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("text/csv, application/json;q=0.5", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("application/json, text/csv", ""), TableFormat::kJson);
  EXPECT_EQ(format_of("text/csv", "json"), TableFormat::kJson);
  EXPECT_EQ(format_of("application/json", "csv"), TableFormat::kCsv);
  EXPECT_THROW(format_of("", "xml"), jobs::InvalidRequest);
}

TEST(FindFormat, WeighsWhatTheHeaderWants) {
  EXPECT_EQ(format_of("application/json;q=0.2, text/csv", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("text/csv;q=0.2, application/json", ""), TableFormat::kJson);
  EXPECT_EQ(format_of("application/json; charset=utf-8 ; Q=0.2,text/csv;q=0.3", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("text/*", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("TEXT/CSV", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("text/html, application/xhtml+xml, application/xml;q=0.9, */*;q=0.8", ""), TableFormat::kJson);  // a browser's
  // The narrowest range counts.
  EXPECT_EQ(format_of("*/*, application/json;q=0.1", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("application/json;q=0, */*;q=0.1", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("application/*;q=0.5, application/x-ndjson", ""), TableFormat::kNdjson);
  // What cannot be had, or read, changes nothing.
  EXPECT_EQ(format_of("image/png", ""), TableFormat::kJson);
  EXPECT_EQ(format_of("text/csv;q=0", ""), TableFormat::kJson);
  EXPECT_EQ(format_of("text/csv;q=many, application/json;q=0.5", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of(", ;q=1, /,", ""), TableFormat::kJson);
}

TEST(JsonRows, HaveEveryColumnInEveryRow) {
  const double third = 1.0 / 3.0;
  const jobs::ResultTable table{{"job_id", "clearance_mm", "peak"}, {{"j\"1", 0.25, third}, {"j2", 0, nullptr}}};
  const json rows = json::parse(server::to_json_rows(table));
  EXPECT_EQ(rows, json::parse(R"([{"job_id": "j\"1", "clearance_mm": 0.25, "peak": 0.3333333333333333},
                                  {"job_id": "j2", "clearance_mm": 0, "peak": null}])"));
}

TEST(JsonRows, EndWithTheStatisticsOfReplicates) {
  jobs::ResultTable table{{"job_id"}, {{"j1"}, {"j2"}}};
  table.replicates = {{.count = 2, .mean = 1.5, .spread = 0.5, .min = 1.0, .max = 2.0}, {.count = 0, .mean = {}, .spread = {}, .min = {}, .max = {}}};
  EXPECT_EQ(server::to_json_rows(table),
            "[\n{\"job_id\":\"j1\",\"replicates_count\":2,\"replicates_mean\":1.5,\"replicates_spread\":0.5,\"replicates_min\":1,\"replicates_max\":2},"
            "\n{\"job_id\":\"j2\",\"replicates_count\":0,\"replicates_mean\":null,\"replicates_spread\":null,\"replicates_min\":null,\"replicates_max\":null}\n]\n");
}

TEST(JsonRows, AreAnEmptyArrayForNoRows) { EXPECT_EQ(json::parse(server::to_json_rows({{"a"}, {}})), json::array()); }

TEST(JsonColumns, AreArraysByTheirKey) {
  engine::Trajectory trajectory;
  trajectory.channels = {{.key = "t_s", .help = ""}, {.key = "z_m", .help = ""}};
  trajectory.columns = {{0.0, 0.001}, {-2.5, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_EQ(json::parse(server::to_json_columns(trajectory)),
            json::parse(R"({"channels": ["t_s", "z_m"], "columns": {"t_s": [0, 0.001], "z_m": [-2.5, null]}})"));
}

TEST(JsonColumns, ReadWithoutAnyChannel) {
  EXPECT_EQ(json::parse(server::to_json_columns({})), json::parse(R"({"channels": [], "columns": {}})"));
}

TEST(MakeTable, NamesTheDownload) {
  const auto csv = server::make_table(TableFormat::kCsv, "a\r\n", "sweep-1");
  EXPECT_EQ(csv.content_type, "text/csv; charset=utf-8");
  EXPECT_EQ(csv.headers.back().second, "attachment; filename=\"sweep-1.csv\"");
  EXPECT_EQ(server::make_table(TableFormat::kJson, "[]", "sweep-1").content_type, "application/json");
}

}  // namespace
