// SPDX-License-Identifier: Apache-2.0
#include "server/http/http.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <list>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/http/http_limits.h"
#include "server/messages/gzip.h"
#include "server/routes/route_table.h"
#include "tests/server/http/raw_client.h"
#include "tests/server/service_fixture.h"

namespace {

using namespace std::chrono_literals;
using server::HttpLimits;
using server::HttpServer;
using server_tests::Bench;
using server_tests::body_of;
using server_tests::RawClient;
using server_tests::status_of;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kBodyBytes = 100'000;

/// Limits that a test can run into without waiting for long.
HttpLimits short_limits() {
  HttpLimits limits;
  limits.body_bytes = kBodyBytes;
  limits.head_time = 400ms;
  limits.body_time = 900ms;
  limits.linger_time = 300ms;
  limits.drain_time = 200ms;
  return limits;
}

class Http : public testing::Test {
 protected:
  Http() : http_(bench_.routes(), {.address = "127.0.0.1", .port = 0}, short_limits()), port_(http_.bind()) {
    if (port_ == 0) throw std::runtime_error("no free port");
    listener_ = std::jthread([this] { http_.listen(); });
  }
  ~Http() override { http_.stop(); }

  /// The answer to these bytes.
  [[nodiscard]] std::string ask(const std::string& bytes) const {
    RawClient client(port_);
    client.send(bytes);
    return client.read_all();
  }

  [[nodiscard]] std::string get(const std::string& path, const std::string& headers = "") const {
    return ask("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n");
  }

  [[nodiscard]] std::string post(const std::string& path, const std::string& body, const std::string& headers = "") const {
    return ask("POST " + path + " HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
               headers + "\r\n" + body);
  }

  [[nodiscard]] std::size_t sweep_count() {
    return nlohmann::json::parse(bench_.call("GET", "/v1/sweeps").body).at("items").size();
  }

  Bench bench_;
  HttpServer http_;
  int port_;
  std::jthread listener_;
};

/// A request that is good and larger than 8 KiB, the library's bound for forms.
std::string padded_request() { return R"({"name": "padded", "sweep": {"clearance_mm": [0.1]})" + std::string(20'000, ' ') + "}"; }

std::string chunked(const std::string& body, std::size_t chunk_bytes) {
  std::string text;
  char size[32];
  for (std::size_t start = 0; start < body.size(); start += chunk_bytes) {
    const std::string chunk = body.substr(start, chunk_bytes);
    std::snprintf(size, sizeof size, "%zx\r\n", chunk.size());
    text += size + chunk + "\r\n";
  }
  return text + "0\r\n\r\n";
}

TEST_F(Http, CarriesOneRequestAConnection) {
  const std::string request = "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: keep-alive\r\n\r\n";
  const std::string answer = ask(request + request);
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(answer.find("HTTP/1.1", 1), std::string::npos) << "two answers";
  EXPECT_NE(answer.find("Connection: close\r\n"), std::string::npos);
}

TEST_F(Http, SendsTheHeadersThatBrowsersObey) {
  for (const std::string& answer : {get("/"), get("/nothing"), ask("GET / HTTP/1.1\r\n\r\n")}) {
    EXPECT_NE(answer.find("X-Content-Type-Options: nosniff\r\n"), std::string::npos) << answer;
    EXPECT_NE(answer.find("Content-Security-Policy: default-src 'none';"), std::string::npos) << answer;
    EXPECT_NE(answer.find("Referrer-Policy: no-referrer\r\n"), std::string::npos) << answer;
  }
}

TEST_F(Http, AnswersInProblemJsonWhateverIsWrong) {
  for (const std::string& answer : {get("/nothing"), ask("GET / HTTP/1.1\r\n\r\n"), ask("FETCH / HTTP/1.1\r\nHost: localhost\r\n\r\n"),
                                    ask("GET / HTTP/3.0\r\nHost: localhost\r\n\r\n"), ask("PUT /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n")}) {
    EXPECT_NE(answer.find("Content-Type: application/problem+json\r\n"), std::string::npos) << answer;
    EXPECT_NE(answer.find("\r\nX-Request-Id: "), std::string::npos) << answer;
    EXPECT_EQ(nlohmann::json::parse(body_of(answer)).at("status"), status_of(answer));
  }
}

TEST_F(Http, DropsAHeadThatComesTooSlowly) {
  RawClient client(port_);
  const auto start = Clock::now();
  client.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nX: ");
  while (!client.answered_within(50ms) && Clock::now() - start < 30s) client.send("a");
  EXPECT_EQ(status_of(client.read_all()), 408);
  // The limit is on the whole head, however many single bytes keep coming.
  EXPECT_LT(Clock::now() - start, 20s);
}

TEST_F(Http, ServesOthersWhileManyHeadsComeSlowly) {
  std::list<RawClient> slow;
  for (int i = 0; i < 40; ++i) slow.emplace_back(port_).send("GET / HTTP/1.1\r\n");
  const auto start = Clock::now();
  EXPECT_EQ(status_of(get("/healthz")), 200);
  EXPECT_LT(Clock::now() - start, 5s);
}

TEST(HttpCrowd, ServesOthersSoonAlthoughHundredsHoldTheirConnections) {
  Bench bench;
  HttpLimits limits;  // as they are: 5 s for a head, 10 s for a body
  limits.crowded_time = 100ms;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0}, limits);
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  std::list<RawClient> slow;
  for (int i = 0; i < 100; ++i) slow.emplace_back(port).send("GET / HTTP/1.1\r\n");
  for (int i = 0; i < 100; ++i) slow.emplace_back(port).send("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n{");
  const auto start = Clock::now();
  RawClient client(port);
  client.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(client.read_all()), 200);
  // Slow heads take no thread; the bodies: four turns of 32 threads at some 0.3 s. With the whole time for each it would be a minute.
  EXPECT_LT(Clock::now() - start, 9s);
  http.stop();
}

TEST(HttpCrowd, ServesOthersAtOnceBesideHundredsThatSayNothingOrLittle) {
  Bench bench;
  HttpLimits limits;  // as they are: one thread each would be theirs for 5 s
  limits.crowded_time = 5s;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0}, limits);
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  std::list<RawClient> others;
  for (int i = 0; i < 200; ++i) others.emplace_back(port);
  for (int i = 0; i < 200; ++i) others.emplace_back(port).send("GET / HTTP/1.1\r\n");
  const auto start = Clock::now();
  RawClient client(port);
  client.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(client.read_all()), 200);
  EXPECT_LT(Clock::now() - start, 4s);
  // Those that wait may go on.
  others.back().send("Host: localhost\r\n\r\n");
  EXPECT_EQ(status_of(others.back().read_all()), 200);
  http.stop();
}

TEST(HttpCrowd, GivesThePlaceOfTheOldestThatWaitsToANewOne) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "with no file to be had the undefined-behaviour sanitizer, which opens a pipe to look at an object, takes any for none";
#endif
  Bench bench;
  rlimit files{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &files), 0);
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0}, HttpLimits{});
  const int port = http.bind();
  ASSERT_NE(port, 0);
  // Few files are left to this process, which has both ends: the last clients have theirs before the server takes the first.
  std::list<RawClient> clients;
  for (int i = 0; i < 40; ++i) clients.emplace_back(port);
  clients.back().send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  static_cast<void>(bench.call("GET", "/v1/sweeps"));  // its files are open
  const auto open = static_cast<rlim_t>(std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}));
  const rlimit few{.rlim_cur = open + 10, .rlim_max = files.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  std::jthread listener([&] { http.listen(); });
  EXPECT_EQ(status_of(clients.back().read_all()), 200);
  EXPECT_TRUE(clients.front().answered_within(5s)) << "the oldest is still there";
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &files), 0);
  http.stop();
}

TEST_F(Http, RefusesAHeadThatIsTooLarge) {
  EXPECT_EQ(status_of(get("/healthz", "X: " + std::string(20'000, 'a') + "\r\n")), 431);
  std::string many;
  for (int i = 0; i < 5'000; ++i) many += "X: 1\r\n";
  EXPECT_EQ(status_of(get("/healthz", many)), 431);
  EXPECT_EQ(status_of(get("/healthz", "X: " + std::string(7'900, 'a') + "\r\n")), 200);
}

TEST_F(Http, RefusesHeadWithoutABody) {
  for (const std::string& head : {std::string("Idempotency-Key:\r\n\r\n"), "X: " + std::string(20'000, 'a')}) {
    const std::string answer = ask("HEAD /healthz HTTP/1.1\r\nHost: localhost\r\n" + head);
    EXPECT_EQ(answer.substr(0, 10), "HTTP/1.1 4");
    EXPECT_EQ(body_of(answer), "");
  }
}

TEST_F(Http, RefusesABodyByItsLengthBeforeItComes) {
  EXPECT_EQ(status_of(ask("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100001\r\n\r\n")), 413);
}

TEST_F(Http, RefusesAChunkedBodyThatGrowsTooLarge) {
  const std::string head = "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n";
  EXPECT_EQ(status_of(ask(head + chunked(std::string(kBodyBytes + 1, ' '), 4000))), 413);
  // No end in sight.
  RawClient client(port_);
  client.send(head);
  const std::string chunk = chunked(std::string(4000, ' '), 4000).substr(0, 4007);
  int sent = 0;
  while (sent < 1000 && !client.answered_within(1ms) && client.send(chunk)) ++sent;
  EXPECT_LT(sent, 1000);
  EXPECT_EQ(status_of(client.read_all()), 413);
}

TEST_F(Http, TakesABodyOfExactlyTheLimit) {
  std::string body = R"({"sweep": {"clearance_mm": [0.1]})";
  body += std::string(kBodyBytes - body.size() - 1, ' ') + "}";
  EXPECT_EQ(status_of(post("/v1/sweeps", body)), 201);
}

TEST_F(Http, BoundsWhatAChunkedBodyIsWrappedIn) {
  // Chunks of one byte: a good request that takes six bytes off the wire for each of its own.
  const std::string body = R"({"sweep": {"clearance_mm": [0.1]})" + std::string(60'000, ' ') + "}";
  const std::string head = "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n";
  EXPECT_EQ(status_of(ask(head + chunked(body, 1))), 400);
  EXPECT_EQ(sweep_count(), 0U);
  EXPECT_EQ(status_of(ask(head + chunked(body, 100))), 201);
}

TEST_F(Http, ReachesAClientThatIsStillSending) {
  RawClient client(port_);
  client.send("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\n");
  // A server that closes with unread bytes resets the connection, and the answer may be lost with it.
  for (int i = 0; i < 4; ++i) {
    std::this_thread::sleep_for(30ms);
    EXPECT_TRUE(client.send(std::string(250'000, ' '))) << i;
  }
  EXPECT_EQ(status_of(client.read_all()), 413);
}

TEST_F(Http, ReadsAHeadThatComesInPieces) {
  RawClient client(port_);
  for (const char* const piece : {"GET /heal", "thz HTTP/1.1\r\nHost: localhost\r", "\n\r", "\n"}) {
    client.send(piece);
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_EQ(status_of(client.read_all()), 200);
}

TEST_F(Http, GivesABodyItsOwnTime) {
  const std::string body = R"({"sweep": {"clearance_mm": [0.1]}})";
  RawClient client(port_);
  client.send("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n");
  std::this_thread::sleep_for(500ms);  // more than a head may take
  client.send(body);
  EXPECT_EQ(status_of(client.read_all()), 201);
}

TEST_F(Http, DropsABodyThatComesTooSlowly) {
  RawClient client(port_);
  const auto start = Clock::now();
  client.send("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n");
  while (!client.answered_within(50ms) && Clock::now() - start < 30s) client.send(" ");
  EXPECT_EQ(status_of(client.read_all()), 400);
  EXPECT_LT(Clock::now() - start, 20s);
  EXPECT_EQ(sweep_count(), 0U);
}

TEST_F(Http, TakesWhatCurlSendsByDefault) {
  // `curl -d @file` calls every body a form.
  EXPECT_EQ(status_of(post("/v1/sweeps", padded_request(), "Content-Type: application/x-www-form-urlencoded\r\n")), 201);
  const std::string head = "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n";
  EXPECT_EQ(status_of(ask(head + chunked(padded_request(), 777))), 201);
}

TEST_F(Http, SaysContinueToAClientThatAsks) {
  RawClient client(port_);
  client.send("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n");
  ASSERT_TRUE(client.answered_within(10s));
  client.send("[]");
  EXPECT_EQ(client.read_all().find("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 422"), 0U);
}

TEST(HttpBody, IsNotAwaitedWhereNoneIsAnnounced) {
  Bench bench;
  HttpLimits limits;
  limits.body_time = 60s;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0}, limits);
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  const auto start = Clock::now();
  RawClient client(port);
  client.send("POST /v1/sweeps/none/cancel HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(client.read_all()), 404);
  EXPECT_LT(Clock::now() - start, 30s);
  http.stop();
}

TEST_F(Http, RefusesBodiesThatAreNotTheText) {
  EXPECT_EQ(status_of(post("/v1/sweeps", "--a--", "Content-Type: multipart/form-data; boundary=a\r\n")), 415);
  EXPECT_EQ(status_of(post("/v1/sweeps", "{}", "Content-Encoding: br\r\n")), 415);
}

TEST_F(Http, IgnoresRangesAndCompression) {
  std::string ranges = "Range: bytes=0-1";
  for (int i = 0; i < 300; ++i) ranges += ",0-999";
  const std::string plain = get("/v1/openapi.json");
  const std::string answer = get("/v1/openapi.json", ranges + "\r\nAccept-Encoding: br, gzip\r\n");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(body_of(answer), body_of(plain));
  EXPECT_EQ(answer.find("Content-Encoding"), std::string::npos);
  EXPECT_EQ(body_of(get("/", ranges + "\r\n")), body_of(get("/")));
  EXPECT_EQ(body_of(get("/", ranges + "\r\nAccept-Encoding: gzip\r\n")), body_of(get("/", "Accept-Encoding: gzip\r\n")));
}

// The pages are compressed when the program is built; nothing is while it serves.
TEST_F(Http, SendsThePageCompressedToWhoeverWantsThat) {
  const std::string plain = get("/index.html");
  EXPECT_EQ(plain.find("Content-Encoding"), std::string::npos);
  EXPECT_NE(plain.find("\r\nVary: Accept-Encoding\r\n"), std::string::npos);
  for (const char* const wish : {"gzip", "br, gzip;q=0.5", "br\r\naccept-encoding: gzip"}) {
    const std::string packed = get("/index.html", std::string("Accept-Encoding: ") + wish + "\r\n");
    EXPECT_EQ(status_of(packed), 200) << wish;
    EXPECT_NE(packed.find("\r\nContent-Encoding: gzip\r\n"), std::string::npos) << wish;
    EXPECT_NE(packed.find("\r\nContent-Length: " + std::to_string(body_of(packed).size()) + "\r\n"), std::string::npos) << wish;
    EXPECT_EQ(server::gunzip(body_of(packed), body_of(plain).size()), body_of(plain)) << wish;
  }
  for (const char* const wish : {"br", "gzip;q=0", "identity", "%67zip"}) {
    EXPECT_EQ(body_of(get("/index.html", std::string("Accept-Encoding: ") + wish + "\r\n")), body_of(plain)) << wish;
  }
}

TEST_F(Http, IgnoresRangesThatAreNone) {
  for (const char* const range : {"bytes=a-b", "bytes=9-1", "lines=1-2", ""}) EXPECT_EQ(status_of(get("/", std::string("range: ") + range + "\r\n")), 200) << range;
}

TEST_F(Http, RefusesOtherNamesAndOtherSites) {
  EXPECT_EQ(status_of(ask("GET /v1/sweeps HTTP/1.1\r\nHost: evil.com\r\n\r\n")), 403);
  const std::string request = R"({"sweep": {"clearance_mm": [0.1]}})";
  EXPECT_EQ(status_of(post("/v1/sweeps", request, "Origin: http://evil.com\r\n")), 403);
  EXPECT_EQ(status_of(post("/v1/sweeps", request, "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\n")), 403);
  EXPECT_EQ(sweep_count(), 0U);
  EXPECT_EQ(status_of(post("/v1/sweeps", request, "Origin: http://localhost\r\nContent-Type: application/json\r\n")), 201);
}

TEST_F(Http, RefusesOtherNamesAndOtherSitesOnEveryRoute) {
  for (const server::Route& route : server::route_table()) {
    std::string path(route.pattern);
    if (const auto id = path.find("{id}"); id != std::string::npos) path.replace(id, 4, "swp_1");
    const std::string line = std::string(route.method) + " " + path + " HTTP/1.1\r\n";
    EXPECT_EQ(status_of(ask(line + "Host: evil.com\r\n\r\n")), 403) << line;
    EXPECT_EQ(status_of(ask(line + "Host: localhost\r\nOrigin: http://evil.com\r\n\r\n")), 403) << line;
    EXPECT_EQ(status_of(ask(line + "Host: localhost\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors\r\n\r\n")), 403) << line;
  }
}

TEST_F(Http, TakesOnlyJsonOfPages) {
  const std::string request = R"({"sweep": {"clearance_mm": [0.1]}})";
  for (const char* const of_a_page : {"Origin: http://localhost\r\n", "Sec-Fetch-Site: same-origin\r\n"}) {
    const auto post_as = [&](const std::string& media) { return status_of(post("/v1/sweeps", request, of_a_page + media)); };
    EXPECT_EQ(post_as("Content-Type: text/plain\r\n"), 415);
    EXPECT_EQ(post_as("Content-Type: application/x-www-form-urlencoded\r\n"), 415);
    EXPECT_EQ(post_as("Content-Type: application/jsonp\r\n"), 415);
    EXPECT_EQ(post_as(""), 415);
    EXPECT_EQ(post_as("Content-Type: application/json; charset=utf-8\r\n"), 201);
    EXPECT_EQ(post_as("Content-Type: Application/JSON\r\n"), 201) << "media types have no case";
    EXPECT_EQ(status_of(ask(std::string("POST /v1/sweeps/none/cancel HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n") + of_a_page + "\r\n")), 404)
        << "nothing is sent";
  }
}

TEST_F(Http, ReadsTheBodyOfAGetAsNothingElse) {
  const std::string answer = ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\nContent-Length: 44\r\n\r\nDELETE /v1/sweeps HTTP/1.1\r\nHost: evil\r\n\r\n");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(answer.find("HTTP/1.1", 1), std::string::npos) << "one answer a connection";
}

TEST_F(Http, SaysNothingToOtherSitesUnlessTheyAreAllowed) {
  const std::string preflight =
      ask("OPTIONS /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nOrigin: https://lab.example.org\r\nAccess-Control-Request-Method: POST\r\n\r\n");
  EXPECT_EQ(status_of(preflight), 403);
  EXPECT_EQ(preflight.find("Access-Control-"), std::string::npos);
  EXPECT_EQ(get("/healthz").find("Access-Control-"), std::string::npos);
}

TEST(HttpCors, LetsTheSitesOnTheListIn) {
  Bench bench;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0, .cors_origins = {"https://lab.example.org"}}, short_limits());
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  const auto ask = [port](const std::string& line, const std::string& origin, const std::string& headers = "", const std::string& body = "") {
    RawClient client(port);
    client.send(line + " HTTP/1.1\r\nHost: localhost\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: cors\r\nOrigin: " + origin + "\r\n" + headers + "\r\n" + body);
    return client.read_all();
  };
  const std::string good = "https://lab.example.org";
  const std::string preflight = ask("OPTIONS /v1/sweeps", good, "Access-Control-Request-Method: POST\r\nAccess-Control-Request-Private-Network: true\r\n");
  EXPECT_EQ(status_of(preflight), 204);
  for (const char* const header : {"Access-Control-Allow-Origin: https://lab.example.org\r\n", "Access-Control-Allow-Methods: GET, HEAD, POST, DELETE\r\n",
                                   "Access-Control-Allow-Headers: Authorization, Content-Type,", "Access-Control-Allow-Private-Network: true\r\n", "Vary: Origin\r\n"}) {
    EXPECT_NE(preflight.find(header), std::string::npos) << header << preflight;
  }
  const std::string body = R"({"sweep": {"clearance_mm": [0.1]}})";
  const std::string posted = ask("POST /v1/sweeps", good, "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n", body);
  EXPECT_EQ(status_of(posted), 201);
  EXPECT_NE(posted.find("Access-Control-Allow-Origin: https://lab.example.org\r\n"), std::string::npos);
  EXPECT_NE(posted.find("Access-Control-Expose-Headers: Content-Disposition, ETag, Location, Preference-Applied,"), std::string::npos);
  // A page may read what it did wrong, too.
  EXPECT_NE(ask("GET /v1/nothing", good).find("Access-Control-Allow-Origin: https://lab.example.org\r\n"), std::string::npos);
  for (const char* const bad : {"https://evil.com", "null"}) {
    const std::string refused = ask("GET /v1/sweeps", bad);
    EXPECT_EQ(status_of(refused), 403) << bad;
    EXPECT_EQ(refused.find("Access-Control-"), std::string::npos) << refused;
    EXPECT_EQ(status_of(ask("OPTIONS /v1/sweeps", bad, "Access-Control-Request-Method: POST\r\n")), 403) << bad;
  }
  http.stop();
}

TEST_F(Http, TakesHeadersLiterally) {
  EXPECT_EQ(status_of(ask("GET /healthz HTTP/1.1\r\nHost: localhost%00.evil.example\r\n\r\n")), 403);
  EXPECT_EQ(status_of(ask("GET /healthz HTTP/1.1\r\nHost: %6cocalhost\r\n\r\n")), 403);
  const std::string request = R"({"sweep": {"clearance_mm": [0.1]}})";
  for (const char* const key : {"kA", "k%41", "k%2541", "k%u0041"}) {
    for (int i = 0; i < 2; ++i) EXPECT_EQ(status_of(post("/v1/sweeps", request, std::string("Idempotency-Key: ") + key + "\r\n")), 201) << key;
  }
  EXPECT_EQ(sweep_count(), 4U) << "one for each key";
  EXPECT_EQ(status_of(post("/v1/sweeps", request, "Origin: http://localhost\r\nContent-Type: application%2Fjson\r\n")), 415);
  EXPECT_EQ(status_of(post("/v1/sweeps", request, "Origin: http://%6cocalhost\r\n")), 403);
  EXPECT_EQ(status_of(get("/v1/sweeps", "Sec-Fetch-Site: %6eone\r\n")), 403);
  EXPECT_EQ(status_of(post("/v1/sweeps", request, "Content-Encoding: %67zip\r\n")), 415);
  EXPECT_EQ(status_of(get("/", "If-None-Match: %2a\r\n")), 200);
  EXPECT_EQ(status_of(get("/", "If-None-Match: \"a\"\r\nIf-None-Match: *\r\n")), 304) << "two lines are one list";
  EXPECT_EQ(status_of(get("/", std::string("X: a") + '\0' + "b\r\n")), 400);
}

TEST(HttpToken, IsTakenLiterally) {
  Bench bench;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0, .token = "correct%41horse%2541battery"}, short_limits());
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  const auto status_with = [port](const std::string& headers) {
    RawClient client(port);
    client.send("GET /v1/sweeps HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n");
    return status_of(client.read_all());
  };
  EXPECT_EQ(status_with("Authorization: Bearer correct%41horse%2541battery\r\n"), 200);
  EXPECT_EQ(status_with("Authorization: Bearer correctAhorse%41battery\r\n"), 401);
  EXPECT_EQ(status_with("Authorization: Bearer correct%2541horse%252541battery\r\n"), 401);
  EXPECT_EQ(status_with("Authorization: Bearer correct%41horse%2541battery\r\nAuthorization: Bearer a\r\n"), 401);
  http.stop();
}

TEST_F(Http, DecodesThePathAndTheQuery) {
  EXPECT_EQ(status_of(get("/v1/%73weeps?limit=%35")), 200);
  EXPECT_EQ(status_of(get("/v1/sweeps?limit=%35%35%35%35%35")), 422);
  EXPECT_EQ(status_of(get("/%0a")), 404);
  EXPECT_EQ(status_of(get("/v1/%2573weeps")), 404) << "decoded once";
  EXPECT_EQ(status_of(get("/v1/sweeps?limit=%2535")), 422) << "decoded once";
  EXPECT_EQ(status_of(get("/v1/%u0073weeps")), 404) << "RFC 3986 knows two digits";
  EXPECT_EQ(status_of(get("/v1/sweeps?limit=5&limit=5")), 422) << "given more than once";
}

TEST_F(Http, SendsNoLengthWithoutContent) {
  const std::string id = bench_.run(R"({"sweep": {"clearance_mm": [0.1]}})");
  const std::string answer = ask("DELETE /v1/sweeps/" + id + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(answer), 204);
  EXPECT_EQ(answer.find("Content-Length"), std::string::npos);
  const std::string head = ask("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(head), 200);
  EXPECT_EQ(body_of(head), "");
}

TEST_F(Http, DoesNotShareItsPort) {
  HttpServer second(bench_.routes(), {.address = "127.0.0.1", .port = port_}, short_limits());
  EXPECT_EQ(second.bind(), 0);
}

TEST(HttpBind, QueuesManyConnectionsAtOnce) {
  Bench bench;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0}, short_limits());
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::list<RawClient> clients;
  Clock::duration longest{};
  // Nobody accepts yet. Where the queue is full a client tries again after one second, then after three.
  for (int i = 0; i < 200; ++i) {
    const auto start = Clock::now();
    clients.emplace_back(port);
    longest = std::max(longest, Clock::now() - start);
    clients.back().send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  EXPECT_LT(longest, 900ms);
  std::jthread listener([&] { http.listen(); });
  for (RawClient& client : clients) EXPECT_EQ(status_of(client.read_all()), 200);
  http.stop();
}

TEST(HttpStop, EndsConnectionsThatWait) {
  Bench bench;
  HttpLimits limits;
  limits.head_time = 60s;  // the end must not wait for them
  limits.drain_time = 200ms;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0}, limits);
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  RawClient idle(port);
  RawClient slow(port);
  slow.send("GET / HTTP/1.1\r\n");
  // Accepted in their order: once a later one has its answer, those two are being read.
  RawClient later(port);
  later.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(later.read_all()), 200);
  const auto start = Clock::now();
  http.stop();
  listener.join();
  EXPECT_LT(Clock::now() - start, 30s);
}

TEST(HttpStop, LeavesThePortToTheNext) {
  Bench bench;
  HttpServer first(bench.routes(), {.address = "127.0.0.1", .port = 0}, short_limits());
  const int port = first.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { first.listen(); });
  RawClient client(port);
  client.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(client.read_all()), 200);
  first.stop();
  listener.join();
  HttpServer second(bench.routes(), {.address = "127.0.0.1", .port = port}, short_limits());
  EXPECT_EQ(second.bind(), port);
}

}  // namespace
