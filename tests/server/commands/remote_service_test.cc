// SPDX-License-Identifier: Apache-2.0
#include "server/commands/remote_service.h"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "server/commands/command.h"
#include "server/commands/remote_commands.h"
#include "tests/server/commands/canned_server.h"

namespace {

using server::parse_service_url;
using server::Unreachable;
using server::commands::BadInput;
using server::commands::Busy;
using server::commands::checked_kind;
using server::commands::fetch_part;
using server::commands::follow;
using server::commands::Kind;
using server::commands::RemoteService;
using server_tests::canned;
using server_tests::CannedServer;

constexpr const char* kProblem = "application/problem+json";
constexpr const char* kBusyProblem =
    R"({"status": 503, "title": "Service Unavailable", "detail": "too many"})";

TEST(ServiceUrl, IsTakenApart) {
  const auto plain = parse_service_url("http://127.0.0.1:8080");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->origin, "http://127.0.0.1:8080");
  EXPECT_EQ(plain->prefix, "");
  const auto behind = parse_service_url("https://lab.example.org/rpsup//");
  ASSERT_TRUE(behind);
  EXPECT_EQ(behind->origin, "https://lab.example.org");
  EXPECT_EQ(behind->prefix, "/rpsup");
  EXPECT_TRUE(parse_service_url("http://[::1]:80/"));
}

TEST(ServiceUrl, IsRefusedIfItIsAnotherThing) {
  for (const char* const url : {"", "127.0.0.1:8080", "ftp://a", "http://", "http://:80", "http://a b",
                                "http://user:pw@host", "http://a?b=c", "http://a/b#c", "http://a/\r\nX: y"}) {
    EXPECT_FALSE(parse_service_url(url)) << url;
  }
}

TEST(RemoteService, SendsTheTokenAndThePrefix) {
  const std::string sweep = R"({"id": "swp_1", "state": "queued"})";
  CannedServer server(
      {canned("201 Created", "application/json", sweep), canned("200 OK", "application/json", sweep)});
  RemoteService with({.url = server.url() + "/lab", .token = "s3cret"});
  EXPECT_EQ(with.submit(Kind::kSweep, {{"name", "a"}}).at("id"), "swp_1");
  RemoteService without({.url = server.url(), .token = ""});
  EXPECT_EQ(without.find(Kind::kSweep, "swp_1").at("state"), "queued");
  ASSERT_EQ(server.heads().size(), 2U);
  EXPECT_TRUE(server.heads()[0].starts_with("POST /lab/v1/sweeps HTTP/1.1\r\n")) << server.heads()[0];
  EXPECT_NE(server.heads()[0].find("\r\nAuthorization: Bearer s3cret\r\n"), std::string::npos)
      << server.heads()[0];
  EXPECT_EQ(server.heads()[1].find("Authorization"), std::string::npos) << server.heads()[1];
}

TEST(RemoteService, RefusesATokenThatWouldBreakTheHead) {
  EXPECT_THROW(RemoteService({.url = "http://127.0.0.1", .token = "a\r\nX: b"}), BadInput);
  EXPECT_THROW(RemoteService({.url = "127.0.0.1", .token = ""}), BadInput);
}

TEST(RemoteService, PassesEveryFaultOn) {
  CannedServer server({canned(
      "422 Unprocessable Content", kProblem,
      R"({"status": 422, "detail": "two", "errors": [{"pointer": "/a", "detail": "x"}, {"pointer": "/b", "detail": "y"}]})")});
  RemoteService service({.url = server.url(), .token = ""});
  try {
    static_cast<void>(service.submit(Kind::kJob, {}));
    FAIL() << "accepted";
  } catch (const jobs::InvalidRequest& error) {
    ASSERT_EQ(error.faults().size(), 2U);
    EXPECT_EQ(error.faults()[1].pointer, "/b");
    EXPECT_EQ(error.faults()[1].detail, "y");
  }
}

TEST(RemoteService, SendsKeysAndEncodedQueries) {
  CannedServer server({canned("201 Created", "application/json", R"({"id": "mea_1"})"),
                       canned("200 OK", "text/csv", "a\r\n"),
                       "HTTP/1.1 204 No Content\r\nConnection: close\r\n\r\n"});
  RemoteService service({.url = server.url(), .token = ""});
  EXPECT_EQ(service.submit_measurement("t,a\n", "text/csv", {{"name", "a b"}}, "key-1").at("id"), "mea_1");
  EXPECT_EQ(service.get_part(Kind::kSweep, "swp_1", "results", "text/csv", {{"a&b", "1,2"}, {"limit", "3"}}),
            "a\r\n");
  service.erase(Kind::kFit, "fit_1");
  const auto& heads = server.heads();
  ASSERT_EQ(heads.size(), 3U);
  EXPECT_TRUE(heads[0].starts_with("POST /v1/measurements?name=a%20b HTTP/1.1\r\n")) << heads[0];
  EXPECT_NE(heads[0].find("\r\nIdempotency-Key: key-1\r\n"), std::string::npos) << heads[0];
  EXPECT_TRUE(heads[1].starts_with("GET /v1/sweeps/swp_1/results?a%26b=1%2C2&limit=3 HTTP/1.1\r\n"))
      << heads[1];
  EXPECT_TRUE(heads[2].starts_with("DELETE /v1/fits/fit_1 HTTP/1.1\r\n")) << heads[2];
}

TEST(RemoteService, KnowsPagesOfTheDashboardBehindAPrefix) {
  RemoteService service({.url = "https://lab.example.org/rpsup/", .token = ""});
  EXPECT_EQ(service.page_of(Kind::kWearStudy, "wst_1"), "https://lab.example.org/rpsup/#/wear/wst_1");
}

TEST(RemoteKinds, AreThoseOfTheIdsThatACommandTakes) {
  EXPECT_EQ(checked_kind("retry", "opt_1"), Kind::kOptimisation);
  EXPECT_EQ(checked_kind("trajectory", "mea_1"), Kind::kMeasurement);
  for (const char* const id : {"job_1", "none", "", "swp_1/../../healthz", "xswp_1"}) {
    try {
      static_cast<void>(checked_kind("retry", id));
      ADD_FAILURE() << "accepted " << id;
    } catch (const BadInput& error) {
      EXPECT_EQ(
          std::string(error.what()),
          "retry " + std::string(id) + ": is no id of a sweep, search, wear study, optimisation or fit");
    }
  }
}

/// Exit code and words for the user after an answer of the service.
struct Told {
  int code;
  std::string words;
};

Told tell(const std::string& answer) {
  CannedServer server({answer});
  testing::internal::CaptureStderr();
  const int code = server::commands::run_guarded([&]() -> int {
    static_cast<void>(RemoteService({.url = server.url(), .token = ""}).list(Kind::kSweep));
    return server::commands::kDone;
  });
  return {code, testing::internal::GetCapturedStderr()};
}

TEST(RemoteService, TellsTheUsersFaultsFromTheServices) {
  const Told conflict = tell(canned("409 Conflict", kProblem, R"({"detail": "the sweep has ended"})"));
  EXPECT_EQ(conflict.code, server::commands::kBadInput);
  EXPECT_EQ(conflict.words, "rpsup: the sweep has ended\n");
  const Told unauthorized = tell(canned("401 Unauthorized", "text/html", "<html>"));
  EXPECT_EQ(unauthorized.code, server::commands::kBadInput);
  EXPECT_NE(unauthorized.words.find("RPSUP_TOKEN"), std::string::npos) << unauthorized.words;
  const Told full = tell(canned("507 Insufficient Storage", kProblem, R"({"detail": "the disk is full"})"));
  EXPECT_EQ(full.code, server::commands::kMachineFailed);
  EXPECT_NE(full.words.find("the disk is full"), std::string::npos) << full.words;
  EXPECT_EQ(tell(canned("429 Too Many Requests", kProblem, R"({"detail": "later"})")).code,
            server::commands::kMachineFailed);
}

TEST(RemoteService, TellsWhatMayWorkLater) {
  const std::string full = R"({"status": 507, "title": "Insufficient Storage", "detail": "no room"})";
  CannedServer server({canned("429 Too Many Requests", kProblem, kBusyProblem),
                       canned("503 Service Unavailable", kProblem, kBusyProblem),
                       canned("502 Bad Gateway", "text/html", "<html>"),
                       canned("504 Gateway Timeout", "text/html", "<html>"),
                       canned("507 Insufficient Storage", kProblem, full)});
  RemoteService service({.url = server.url(), .token = ""});
  const auto ask = [&] { static_cast<void>(service.find(Kind::kSweep, "swp_1")); };
  for (int k = 0; k < 4; ++k) EXPECT_THROW(ask(), Busy) << k;
  try {
    ask();
    FAIL() << "answered";
  } catch (const Busy&) {
    FAIL() << "a full disk is no matter of time";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no room"), std::string::npos) << error.what();
  }
}

TEST(Follow, IsPatientWithABusyService) {
  const char* const json_type = "application/json";
  const std::string busy = canned("503 Service Unavailable", kProblem, kBusyProblem);
  CannedServer server({busy, canned("200 OK", json_type, R"({"id": "job_1", "state": "running"})"),
                       canned("502 Bad Gateway", "text/html", "<html>"),
                       canned("200 OK", json_type, R"({"id": "job_1", "state": "succeeded"})"), busy,
                       canned("200 OK", "text/csv", "a\n1\n")});
  RemoteService service({.url = server.url(), .token = ""});
  testing::internal::CaptureStderr();
  const auto ended = follow(service, Kind::kJob, "job_1");
  const std::string table = fetch_part(service, Kind::kSweep, "swp_1", "results", "text/csv");
  const std::string told = testing::internal::GetCapturedStderr();
  ASSERT_TRUE(ended.has_value());
  EXPECT_EQ(ended->at("state"), "succeeded");
  EXPECT_EQ(table, "a\n1\n");
  EXPECT_NE(told.find("too many; trying again for 120 s"), std::string::npos) << told;
}

TEST(RemoteService, NoticesThatSomethingElseAnswers) {
  for (const std::string& answer :
       {canned("200 OK", "text/html", "<html>"), canned("200 OK", "application/json", "[]"),
        canned("404 Not Found", "text/html", "<html>"), canned("404 Not Found", kProblem, "{}")}) {
    const Told told = tell(answer);
    EXPECT_EQ(told.code, server::commands::kMachineFailed);
    EXPECT_NE(told.words.find("not as this service does"), std::string::npos) << told.words;
  }
}

TEST(RemoteService, SaysThatNothingAnswers) {
  int port = 0;
  {
    const CannedServer gone({});
    port = std::stoi(gone.url().substr(17));
  }
  RemoteService service({.url = "http://127.0.0.1:" + std::to_string(port), .token = ""});
  EXPECT_THROW(static_cast<void>(service.list(Kind::kSweep)), Unreachable);
  // Half an answer is none.
  CannedServer half({"HTTP/1.1 200 OK\r\nContent-Length: 100\r\n\r\n{"});
  EXPECT_THROW(static_cast<void>(RemoteService({.url = half.url(), .token = ""}).list(Kind::kSweep)),
               Unreachable);
}

}  // namespace
