// SPDX-License-Identifier: Apache-2.0
// Requests and answers of the server: heads, bodies, what is ignored.

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <iterator>
#include <regex>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/http/http.h"
#include "server/http/http_date.h"
#include "server/messages/gzip.h"
#include "tests/server/http/http_fixture.h"
#include "tests/server/http/raw_client.h"

namespace server_tests {
namespace {

using namespace std::chrono_literals;
using server::HttpServer;

/// A request that is good and larger than 8 KiB, the library's bound for forms.
std::string padded_request() {
  return R"({"name": "padded", "sweep": {"clearance_mm": [0.1]})" + std::string(20'000, ' ') + "}";
}

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

TEST_F(Http, DatesEveryAnswer) {
  EXPECT_EQ(server::http_date(784'111'777'999), "Sun, 06 Nov 1994 08:49:37 GMT");
  EXPECT_EQ(server::http_date(951'782'400'000), "Tue, 29 Feb 2000 00:00:00 GMT");
  const std::regex date("\r\nDate: [A-Z][a-z]{2}, [0-9]{2} [A-Z][a-z]{2} [0-9]{4} [0-9:]{8} GMT\r\n");
  for (const std::string& answer :
       {get("/healthz"), get("/nothing"), get("/", "If-None-Match: *\r\n"), get("/" + std::string(600, 'a')),
        ask("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n"), ask("GET / HTTP/1.1\r\nHost: localhost\r\n")}) {
    const std::string head = answer.substr(0, answer.find("\r\n\r\n") + 2);
    EXPECT_EQ(std::distance(std::sregex_iterator(head.begin(), head.end(), date), {}), 1) << head;
  }
}

TEST_F(Http, AnswersInProblemJsonWhateverIsWrong) {
  for (const std::string& answer :
       {get("/nothing"), ask("GET / HTTP/1.1\r\n\r\n"), ask("FETCH / HTTP/1.1\r\nHost: localhost\r\n\r\n"),
        ask("GET / HTTP/3.0\r\nHost: localhost\r\n\r\n"),
        ask("PUT /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n")}) {
    EXPECT_NE(answer.find("Content-Type: application/problem+json\r\n"), std::string::npos) << answer;
    EXPECT_NE(answer.find("\r\nX-Request-Id: "), std::string::npos) << answer;
    EXPECT_EQ(nlohmann::json::parse(body_of(answer)).at("status"), status_of(answer));
  }
}

TEST_F(Http, TakesTheBodyOfAPatch) {
  const auto patch = [&](const std::string& body, const std::string& head = "") {
    return ask("PATCH /v1/sweeps/swp_none HTTP/1.1\r\nHost: localhost\r\n" + head + "Content-Length: " +
               std::to_string(body.size()) + "\r\n\r\n" + body);
  };
  EXPECT_EQ(status_of(patch(R"({"name": "x"})")), 404) << "understood: there is no such sweep";
  EXPECT_EQ(status_of(patch("name")), 400);
  EXPECT_EQ(status_of(patch(R"({"name": "x"})", "Origin: https://evil.example\r\n")), 403);
}

TEST_F(Http, RefusesAHeadThatIsTooLarge) {
  EXPECT_EQ(status_of(get("/healthz", "X: " + std::string(20'000, 'a') + "\r\n")), 431);
  std::string many;
  for (int i = 0; i < 5'000; ++i) many += "X: 1\r\n";
  EXPECT_EQ(status_of(get("/healthz", many)), 431);
  EXPECT_EQ(status_of(get("/healthz", "X: " + std::string(7'900, 'a') + "\r\n")), 200);
}

TEST_F(Http, CountsARequestOnceWhoeverAnswersIt) {
  EXPECT_EQ(status_of(get("/healthz")), 200);
  EXPECT_EQ(status_of(get("/nothing")), 404);
  EXPECT_EQ(status_of(get("/healthz", "X: " + std::string(20'000, 'a') + "\r\n")), 431);
  EXPECT_EQ(status_of(ask("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100001\r\n\r\n")),
            413);
  EXPECT_EQ(status_of(ask("HEAD / HTTP/1.1\r\nHost: evil.com\r\n\r\n")), 403);
  EXPECT_EQ(status_of(post("/v1/sweeps", "{}", "Content-Encoding: br\r\n")), 415);
  EXPECT_EQ(status_of(ask("GET / HTTP/1.1\r\nHost: localhost\r\n")), 408);
  const std::string text = body_of(get("/metrics"));
  for (const char* const labels :
       {R"(method="GET",route="/healthz",status="200")", R"(method="GET",route="none",status="404")",
        R"(method="GET",route="none",status="431")", R"(method="POST",route="none",status="413")",
        R"(method="HEAD",route="none",status="403")", R"(method="POST",route="none",status="415")",
        R"(method="GET",route="none",status="408")"}) {
    EXPECT_NE(text.find("rpsup_http_request_duration_seconds_count{" + std::string(labels) + "} 1\n"),
              std::string::npos)
        << labels << text;
  }
}

TEST_F(Http, RefusesHeadWithoutABody) {
  for (const std::string& head :
       {std::string("Idempotency-Key:\r\n\r\n"), "X: " + std::string(20'000, 'a')}) {
    const std::string answer = ask("HEAD /healthz HTTP/1.1\r\nHost: localhost\r\n" + head);
    EXPECT_EQ(answer.substr(0, 10), "HTTP/1.1 4");
    EXPECT_EQ(body_of(answer), "");
  }
}

TEST_F(Http, RefusesABodyByItsLengthBeforeItComes) {
  EXPECT_EQ(status_of(ask("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100001\r\n\r\n")),
            413);
}

TEST_F(Http, RefusesAChunkedBodyThatGrowsTooLarge) {
  const std::string head =
      "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n";
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

TEST_F(Http, TakesALargerBodyOfAMeasurement) {
  std::string csv = "time_s,force_n\n";
  for (int k = 0; csv.size() < 3 * kBodyBytes; ++k) csv += std::to_string(k) + ",0.5\n";
  const std::string type = "Content-Type: text/csv\r\n";
  EXPECT_EQ(status_of(post("/v1/measurements", csv, type)), 201);
  EXPECT_EQ(status_of(ask("POST /v1/measurements?name=chunks HTTP/1.1\r\nHost: localhost\r\n" + type +
                          "Transfer-Encoding: chunked\r\n\r\n" + chunked(csv, 4000))),
            201);
  EXPECT_EQ(status_of(post("/v1/sweeps", csv)), 413);
  const std::string length = "Content-Length: " + std::to_string(kMeasurementBodyBytes + 1);
  EXPECT_EQ(
      status_of(ask("POST /v1/measurements HTTP/1.1\r\nHost: localhost\r\n" + length + "\r\n\r\n")), 413);
}

TEST_F(Http, TakesABodyOfExactlyTheLimit) {
  std::string body = R"({"sweep": {"clearance_mm": [0.1]})";
  body += std::string(kBodyBytes - body.size() - 1, ' ') + "}";
  EXPECT_EQ(status_of(post("/v1/sweeps", body)), 201);
}

TEST_F(Http, BoundsWhatAChunkedBodyIsWrappedIn) {
  // Chunks of one byte: a good request that takes six bytes off the wire for each of its own.
  const std::string body = R"({"sweep": {"clearance_mm": [0.1]})" + std::string(60'000, ' ') + "}";
  const std::string head =
      "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n";
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
  client.send("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: " +
              std::to_string(body.size()) + "\r\n\r\n");
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
  EXPECT_EQ(
      status_of(post("/v1/sweeps", padded_request(), "Content-Type: application/x-www-form-urlencoded\r\n")),
      201);
  const std::string head =
      "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n";
  EXPECT_EQ(status_of(ask(head + chunked(padded_request(), 777))), 201);
}

TEST_F(Http, TakesTrailersAfterChunks) {
  const std::string body = R"({"sweep": {"clearance_mm": [0.1]}})";
  const std::string wire = chunked(body, 5);
  EXPECT_EQ(status_of(ask("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\nTrailer: Checksum\r\n\r\n" +
                          wire.substr(0, wire.size() - 2) + "Checksum: 1\r\n\r\n")),
            201);
  EXPECT_EQ(sweep_count(), 1U);
}

TEST_F(Http, SaysContinueToAClientThatAsks) {
  RawClient client(port_);
  client.send(
      "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n");
  ASSERT_TRUE(client.answered_within(60s));
  client.send("[]");
  EXPECT_EQ(client.read_all().find("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 422"), 0U);
}

TEST_F(Http, SkipsLineEndsBeforeTheRequest) {
  EXPECT_EQ(status_of(ask("\r\nGET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n")), 200);
  EXPECT_EQ(status_of(ask("\r\n\r\n\r\nGET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n")), 200);
  RawClient client(port_);
  for (const char* const piece : {"\r", "\n", "\r\n", "G", "ET /healthz HTTP/1.1\r\nHost: localhost\r\n\r", "\n"}) {
    client.send(piece);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(status_of(client.read_all()), 200);
}

TEST_F(Http, TakesNothingButAPortAfterANameInBrackets) {
  for (const char* const host : {"[::1]", "[::1]:8080", "[::1]:"})
    EXPECT_EQ(status_of(ask(std::string("GET /v1/sweeps HTTP/1.1\r\nHost: ") + host + "\r\n\r\n")), 200) << host;
  for (const char* const host :
       {"[::1]evil.com", "[::1].evil.com", "[::1]:80evil.com", "[::1]:8080:evil.com", "localhost:evil.com",
        "localhost:80@evil.com", "127.0.0.1:80.evil.com", "[::1", "[]"})
    EXPECT_EQ(status_of(ask(std::string("GET /v1/sweeps HTTP/1.1\r\nHost: ") + host + "\r\n\r\n")), 403) << host;
}

TEST(HttpToken, ComesBeforeContinue) {
  Bench bench;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0, .token = "a-token-of-sixteen"}, short_limits());
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  const std::string head =
      "POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nContent-Length: 2\r\n";
  RawClient stranger(port);
  stranger.send(head + "\r\n");
  EXPECT_EQ(stranger.read_status(), 401) << "a body is asked for that is not to be read";
  RawClient client(port);
  client.send(head + "Authorization: Bearer a-token-of-sixteen\r\n\r\n");
  EXPECT_EQ(client.read_status(), 100);
  client.send("{]");
  EXPECT_NE(client.read_all().find("HTTP/1.1 400"), std::string::npos);
  RawClient too_large(port);
  too_large.send("POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nContent-Length: 200000\r\n"
                 "Authorization: Bearer a-token-of-sixteen\r\n\r\n");
  EXPECT_EQ(too_large.read_status(), 413);
  http.stop();
}

TEST(HttpBody, IsNotAwaitedWhereNoneIsAnnounced) {
  Bench bench;
  server::HttpLimits limits;
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
  EXPECT_EQ(body_of(get("/", ranges + "\r\nAccept-Encoding: gzip\r\n")),
            body_of(get("/", "Accept-Encoding: gzip\r\n")));
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
    EXPECT_NE(packed.find("\r\nContent-Length: " + std::to_string(body_of(packed).size()) + "\r\n"),
              std::string::npos)
        << wish;
    EXPECT_EQ(server::gunzip(body_of(packed), body_of(plain).size()), body_of(plain)) << wish;
  }
  for (const char* const wish : {"br", "gzip;q=0", "identity", "%67zip"}) {
    EXPECT_EQ(body_of(get("/index.html", std::string("Accept-Encoding: ") + wish + "\r\n")), body_of(plain))
        << wish;
  }
}

TEST_F(Http, IgnoresRangesThatAreNone) {
  for (const char* const range : {"bytes=a-b", "bytes=9-1", "lines=1-2", ""})
    EXPECT_EQ(status_of(get("/", std::string("range: ") + range + "\r\n")), 200) << range;
}

TEST(HttpAnswers, MayBeLargeOneAfterTheOther) {
  Bench bench(endless_run);
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0}, short_limits());
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  const std::string path =
      "/v1/sweeps/" +
      bench.submit(R"({"sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 10000}}})") + "/results";
  EXPECT_GT(bench.routes().answer({"GET", path, {}, "", "", "test-1"}).body.size(), 1'048'576U);
  for (int k = 0; k < 10; ++k) {
    RawClient client(port);
    client.send("HEAD " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(status_of(client.read_all()), 200) << k;
  }
  http.stop();
}

TEST_F(Http, ReadsTheBodyOfAGetAsNothingElse) {
  const std::string answer =
      ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\nContent-Length: 44\r\n\r\nDELETE /v1/sweeps "
          "HTTP/1.1\r\nHost: evil\r\n\r\n");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(answer.find("HTTP/1.1", 1), std::string::npos) << "one answer a connection";
}

// The host of the target counts, not that of the header.
TEST_F(Http, TakesATargetWithItsHost) {
  const std::string answer = ask("GET http://localhost:" + std::to_string(port_) + "/v1/sweeps?limit=1 HTTP/1.1\r\nHost: other\r\n\r\n");
  EXPECT_EQ(status_of(answer), 200) << answer;
  EXPECT_EQ(status_of(ask("GET http://localhost HTTP/1.1\r\nHost: localhost\r\n\r\n")), 200);
  EXPECT_EQ(status_of(ask("GET http://evil.example/v1/sweeps HTTP/1.1\r\nHost: localhost\r\n\r\n")), 403);
  EXPECT_EQ(status_of(ask("GET http://localhost/v1/sweeps?nothing=1 HTTP/1.1\r\nHost: localhost\r\n\r\n")), 422);
}

// Probes of clusters and load balancers name the address of a pod, or no host at all.
TEST_F(Http, AnswersProbesUnderEveryName) {
  for (const char* const path : {"/healthz", "/readyz"}) {
    for (const char* const head : {" HTTP/1.1\r\nHost: 10.1.2.3:8080\r\n\r\n", " HTTP/1.1\r\nHost: evil.example\r\n\r\n", " HTTP/1.0\r\n\r\n",
                                   " HTTP/1.0\r\nHost: other\r\n\r\n"})
      EXPECT_EQ(status_of(ask(std::string("GET ") + path + head)), 200) << path << head;
    EXPECT_EQ(status_of(ask(std::string("GET ") + path + " HTTP/1.1\r\n\r\n")), 400) << "HTTP/1.1 has a Host";
    EXPECT_EQ(status_of(ask(std::string("GET ") + path + " HTTP/1.1\r\nHost: localhost\r\nOrigin: http://evil.example\r\n\r\n")), 403);
  }
  EXPECT_EQ(status_of(ask("GET /v1/sweeps HTTP/1.0\r\n\r\n")), 403);
  EXPECT_EQ(status_of(ask("GET /v1/sweeps HTTP/1.0\r\nHost: localhost\r\n\r\n")), 200);
}

TEST_F(Http, WritesLinksAsTheProxyShowsThem) {
  const std::string body = R"({"sweep": {"clearance_mm": [0.1]}})";
  const std::string posted = post("/v1/sweeps", body, "X-Forwarded-Prefix: /user/a/proxy/8080/\r\nIdempotency-Key: k\r\n");
  const std::string id = nlohmann::json::parse(body_of(posted)).at("id");
  EXPECT_NE(posted.find("Location: /user/a/proxy/8080/v1/sweeps/" + id + "\r\n"), std::string::npos) << posted;
  const auto links = [](const std::string& answer) { return nlohmann::json::parse(body_of(answer)).at("links"); };
  EXPECT_EQ(links(posted).at("results"), "/user/a/proxy/8080/v1/sweeps/" + id + "/results");
  EXPECT_EQ(links(posted).at("study"), nullptr);
  EXPECT_EQ(links(get("/v1/sweeps/" + id, "X-Forwarded-Prefix: /x\r\n")).at("self"), "/x/v1/sweeps/" + id);
  const auto page = nlohmann::json::parse(body_of(get("/v1/sweeps", "X-Forwarded-Prefix: /x\r\n")));
  EXPECT_EQ(page.at("items").at(0).at("links").at("self"), "/x/v1/sweeps/" + id);
  // The answer stored under the key names no proxy. A prefix that is no path is ignored.
  EXPECT_EQ(links(post("/v1/sweeps", body, "Idempotency-Key: k\r\n")).at("self"), "/v1/sweeps/" + id);
  for (const char* const bad : {"//evil.example", "https://evil.example", "/a/..", "x"})
    EXPECT_EQ(links(get("/v1/sweeps/" + id, std::string("X-Forwarded-Prefix: ") + bad + "\r\n")).at("self"), "/v1/sweeps/" + id) << bad;
}

TEST(HttpBasePath, IsAcceptedBeforeEveryPath) {
  Bench bench;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0, .token = "0123456789abcdef", .base_path = "/a/rpsup"}, short_limits());
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  const auto ask = [port](const std::string& path) {
    RawClient client(port);
    client.send("GET " + path + " HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer 0123456789abcdef\r\n\r\n");
    return client.read_all();
  };
  const std::string id = bench.submit(R"({"sweep": {"clearance_mm": [0.1]}})");
  for (const std::string& path : {"/a/rpsup/v1/sweeps/" + id, "/v1/sweeps/" + id}) {
    const std::string answer = ask(path);
    EXPECT_EQ(status_of(answer), 200) << path;
    EXPECT_EQ(nlohmann::json::parse(body_of(answer)).at("links").at("self"), "/a/rpsup/v1/sweeps/" + id) << path;
  }
  EXPECT_NE(ask("/a/rpsup/").find("src=\"app.js\""), std::string::npos);
  const std::string without_slash = ask("/a/rpsup");
  EXPECT_EQ(status_of(without_slash), 308);
  EXPECT_NE(without_slash.find("Location: rpsup/\r\n"), std::string::npos) << without_slash;
  EXPECT_EQ(status_of(ask("/a/rpsup2/v1/sweeps")), 404);
  RawClient probe(port);
  probe.send("GET /a/rpsup/healthz HTTP/1.0\r\n\r\n");
  EXPECT_EQ(status_of(probe.read_all()), 200) << "without the token, too";
  http.stop();
}

TEST_F(Http, LeadsFromASlashTooMany) {
  for (const auto& [path, location] : {std::pair{"/v1/sweeps/", "../sweeps"}, {"/v1/sweeps/?limit=5&state=", "../sweeps?limit=5&state="}, {"/docs/", "../docs"},
                                       {"/v1/sweeps//", "../../sweeps"}, {"/v1/sweeps/swp_0/results/?clearance_mm_gt=a%26b", "../results?clearance_mm_gt=a%26b"}}) {
    const std::string answer = get(path);
    EXPECT_EQ(status_of(answer), 308) << path;
    EXPECT_NE(answer.find(std::string("Location: ") + location + "\r\n"), std::string::npos) << path << answer;
  }
  const std::string posted = post("/v1/sweeps/", "{}");
  EXPECT_EQ(status_of(posted), 404);
  EXPECT_NE(posted.find("/v1/sweeps, without a slash at its end, is meant"), std::string::npos) << posted;
  for (const char* const path : {"/nothing/", "//", "//evil.example/", "/v1/nothing/"}) EXPECT_EQ(status_of(get(path)), 404) << path;
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

}  // namespace
}  // namespace server_tests
