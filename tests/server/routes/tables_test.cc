// SPDX-License-Identifier: Apache-2.0
#include "server/routes/tables.h"

#include <string>

#include <gtest/gtest.h>

namespace {

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
  // a browser's
  EXPECT_EQ(format_of("text/html, application/xhtml+xml, application/xml;q=0.9, */*;q=0.8", ""),
            TableFormat::kJson);
  // The narrowest range counts.
  EXPECT_EQ(format_of("*/*, application/json;q=0.1", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("application/json;q=0, */*;q=0.1", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of("application/*;q=0.5, application/x-ndjson", ""), TableFormat::kNdjson);
  // Unknown and excluded types change nothing, nor do unreadable weights and entries.
  EXPECT_EQ(format_of("image/png", ""), TableFormat::kJson);
  EXPECT_EQ(format_of("text/csv;q=0", ""), TableFormat::kJson);
  EXPECT_EQ(format_of("text/csv;q=many, application/json;q=0.5", ""), TableFormat::kCsv);
  EXPECT_EQ(format_of(", ;q=1, /,", ""), TableFormat::kJson);
}

TEST(MakeTable, NamesTheDownload) {
  const auto csv = server::make_table(TableFormat::kCsv, "a\r\n", "sweep-1");
  EXPECT_EQ(csv.content_type, "text/csv; charset=utf-8");
  EXPECT_EQ(csv.headers.back().second, "attachment; filename=\"sweep-1.csv\"");
  EXPECT_EQ(server::make_table(TableFormat::kJson, "[]", "sweep-1").content_type, "application/json");
}

}  // namespace
