// SPDX-License-Identifier: Apache-2.0
#include "server/messages/query.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

using server::Query;
using server::Request;

constexpr std::array<std::string_view, 2> kWords{"csv", "json"};

Request request_with(std::vector<std::pair<std::string, std::string>> query) {
  Request request;
  request.query = std::move(query);
  return request;
}

/// The pointers of all faults, with blanks between.
std::string faults_of(const Query& query) {
  try {
    query.check();
  } catch (const jobs::InvalidRequest& error) {
    std::string pointers;
    for (const auto& fault : error.faults()) pointers += (pointers.empty() ? "" : " ") + fault.pointer;
    return pointers;
  }
  return "none";
}

TEST(Query, ReadsWhatIsThere) {
  const Request request =
      request_with({{"channels", "a,b"}, {"from", "-1.5e-1"}, {"limit", "7"}, {"format", "csv"}});
  Query query(request, {"channels", "from", "to", "limit", "format"});
  EXPECT_EQ(query.list("channels"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(query.number("from"), -0.15);
  EXPECT_EQ(query.number("to"), std::nullopt);
  EXPECT_EQ(query.count("limit"), 7U);
  EXPECT_EQ(query.word("format", kWords), "csv");
  EXPECT_EQ(faults_of(query), "none");
}

TEST(Query, CollectsEveryFault) {
  const Request request = request_with(
      {{"fromm", "1"}, {"from", "1x"}, {"to", "nan"}, {"limit", "-1"}, {"format", "xml"}, {"fields", ""}});
  Query query(request, {"fields", "from", "to", "limit", "format"});
  EXPECT_EQ(query.number("from"), std::nullopt);
  EXPECT_EQ(query.number("to"), std::nullopt);
  EXPECT_EQ(query.count("limit"), std::nullopt);
  EXPECT_EQ(query.word("format", kWords), std::nullopt);
  EXPECT_EQ(query.names("fields"), "");
  EXPECT_EQ(faults_of(query), "/fromm /from /to /limit /format /fields");
}

TEST(Query, AddsTheFaultsThatTheServiceFinds) {
  const Request request = request_with({{"limit", "x"}});
  Query query(request, {"limit"});
  EXPECT_EQ(query.count("limit"), std::nullopt);
  const auto refuse = []() -> int {
    throw jobs::InvalidRequest({{"/state", "must be another"}, {"/cursor", "must be another"}});
  };
  EXPECT_THROW((void)query.check_and(refuse), jobs::InvalidRequest);
  EXPECT_EQ(faults_of(query), "/limit /state /cursor");
}

TEST(Query, HandsOutWhatTheServiceAnswers) {
  const Request request = request_with({});
  EXPECT_EQ(Query(request, {}).check_and([] { return 7; }), 7);
}

TEST(Query, NamesTheKeysThatAreAllowed) {
  const Request request = request_with({{"x", ""}});
  try {
    Query(request, {"state", "limit"}).check();
    FAIL() << "accepted";
  } catch (const jobs::InvalidRequest& error) {
    EXPECT_NE(error.faults().at(0).detail.find("state, limit"), std::string::npos);
  }
}

TEST(Query, RefusesAKeyGivenTwice) {
  const Request request = request_with({{"limit", "1"}, {"limit", "2"}});
  EXPECT_EQ(faults_of(Query(request, {"limit"})), "/limit");
}

}  // namespace
