// SPDX-License-Identifier: Apache-2.0
// Whom the server answers: names of the host, other sites, tokens.

#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/http/http.h"
#include "server/routes/route_table.h"
#include "tests/server/http/http_fixture.h"
#include "tests/server/http/raw_client.h"

namespace server_tests {
namespace {

using server::HttpServer;

TEST_F(Http, RefusesOtherNamesAndOtherSites) {
  EXPECT_EQ(status_of(ask("GET /v1/sweeps HTTP/1.1\r\nHost: evil.com\r\n\r\n")), 403);
  const std::string request = R"({"sweep": {"clearance_mm": [0.1]}})";
  EXPECT_EQ(status_of(post("/v1/sweeps", request, "Origin: http://evil.com\r\n")), 403);
  EXPECT_EQ(
      status_of(post("/v1/sweeps", request, "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\n")),
      403);
  EXPECT_EQ(sweep_count(), 0U);
  EXPECT_EQ(status_of(post("/v1/sweeps", request,
                           "Origin: http://localhost\r\nContent-Type: application/json\r\n")),
            201);
}

TEST_F(Http, RefusesOtherNamesAndOtherSitesOnEveryRoute) {
  for (const server::Route& route : server::route_table()) {
    std::string path(route.pattern);
    if (const auto id = path.find("{id}"); id != std::string::npos) path.replace(id, 4, "swp_1");
    const std::string line = std::string(route.method) + " " + path + " HTTP/1.1\r\n";
    const bool probe = path == "/healthz" || path == "/readyz";  // answered under every name
    EXPECT_EQ(status_of(ask(line + "Host: evil.com\r\n\r\n")), probe ? 200 : 403) << line;
    EXPECT_EQ(status_of(ask(line + "Host: evil%2ecom\r\n\r\n")), 403) << line;
    EXPECT_EQ(status_of(ask(line + "Host: localhost\r\nOrigin: http://evil.com\r\n\r\n")), 403) << line;
    EXPECT_EQ(status_of(ask(
                  line + "Host: localhost\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors\r\n\r\n")),
              403)
        << line;
  }
}

TEST_F(Http, TakesOnlyJsonOfPages) {
  const std::string request = R"({"sweep": {"clearance_mm": [0.1]}})";
  for (const char* const of_a_page : {"Origin: http://localhost\r\n", "Sec-Fetch-Site: same-origin\r\n"}) {
    const auto post_as = [&](const std::string& media) {
      return status_of(post("/v1/sweeps", request, of_a_page + media));
    };
    EXPECT_EQ(post_as("Content-Type: text/plain\r\n"), 415);
    EXPECT_EQ(post_as("Content-Type: application/x-www-form-urlencoded\r\n"), 415);
    EXPECT_EQ(post_as("Content-Type: application/jsonp\r\n"), 415);
    EXPECT_EQ(post_as(""), 415);
    EXPECT_EQ(post_as("Content-Type: application/json; charset=utf-8\r\n"), 201);
    EXPECT_EQ(post_as("Content-Type: Application/JSON\r\n"), 201) << "media types have no case";
    EXPECT_EQ(
        status_of(ask(
            std::string("POST /v1/sweeps/none/cancel HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n") +
            of_a_page + "\r\n")),
        404)
        << "nothing is sent";
  }
}

TEST_F(Http, SaysNothingToOtherSitesUnlessTheyAreAllowed) {
  const std::string preflight =
      ask("OPTIONS /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nOrigin: "
          "https://lab.example.org\r\nAccess-Control-Request-Method: POST\r\n\r\n");
  EXPECT_EQ(status_of(preflight), 403);
  EXPECT_EQ(preflight.find("Access-Control-"), std::string::npos);
  EXPECT_EQ(get("/healthz").find("Access-Control-"), std::string::npos);
}

TEST(HttpCors, LetsTheSitesOnTheListIn) {
  Bench bench;
  HttpServer http(bench.routes(),
                  {.address = "127.0.0.1", .port = 0, .cors_origins = {"https://lab.example.org"}},
                  short_limits());
  const int port = http.bind();
  ASSERT_NE(port, 0);
  std::jthread listener([&] { http.listen(); });
  const auto ask = [port](const std::string& line, const std::string& origin, const std::string& headers = "",
                          const std::string& body = "") {
    RawClient client(port);
    client.send(
        line +
        " HTTP/1.1\r\nHost: localhost\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: cors\r\nOrigin: " +
        origin + "\r\n" + headers + "\r\n" + body);
    return client.read_all();
  };
  const std::string good = "https://lab.example.org";
  const std::string preflight =
      ask("OPTIONS /v1/sweeps", good,
          "Access-Control-Request-Method: POST\r\nAccess-Control-Request-Private-Network: true\r\n");
  EXPECT_EQ(status_of(preflight), 204);
  for (const char* const header : {"Access-Control-Allow-Origin: https://lab.example.org\r\n",
                                   "Access-Control-Allow-Methods: GET, HEAD, POST, PATCH, DELETE\r\n",
                                   "Access-Control-Allow-Headers: Authorization, Content-Type,",
                                   "Access-Control-Allow-Private-Network: true\r\n", "Vary: Origin\r\n"}) {
    EXPECT_NE(preflight.find(header), std::string::npos) << header << preflight;
  }
  const std::string body = R"({"sweep": {"clearance_mm": [0.1]}})";
  const std::string posted =
      ask("POST /v1/sweeps", good,
          "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n", body);
  EXPECT_EQ(status_of(posted), 201);
  EXPECT_NE(posted.find("Access-Control-Allow-Origin: https://lab.example.org\r\n"), std::string::npos);
  EXPECT_NE(posted.find("Access-Control-Expose-Headers: Accept-Ranges, Content-Disposition, Content-Range, "
                        "ETag, Location,"),
            std::string::npos);
  // A page may read what it did wrong, too.
  EXPECT_NE(ask("GET /v1/nothing", good).find("Access-Control-Allow-Origin: https://lab.example.org\r\n"),
            std::string::npos);
  // So it may where nothing but the head was looked at.
  const std::string too_long = "GET /" + std::string(600, 'a');
  const std::string refused_early = ask(too_long, good);
  EXPECT_EQ(status_of(refused_early), 414);
  EXPECT_NE(refused_early.find("Access-Control-Allow-Origin: https://lab.example.org\r\n"),
            std::string::npos);
  EXPECT_NE(refused_early.find("Vary: Origin\r\n"), std::string::npos);
  EXPECT_EQ(ask(too_long, "https://evil.com").find("Access-Control-"), std::string::npos);
  for (const char* const bad : {"https://evil.com", "null"}) {
    const std::string refused = ask("GET /v1/sweeps", bad);
    EXPECT_EQ(status_of(refused), 403) << bad;
    EXPECT_EQ(refused.find("Access-Control-"), std::string::npos) << refused;
    EXPECT_EQ(status_of(ask("OPTIONS /v1/sweeps", bad, "Access-Control-Request-Method: POST\r\n")), 403)
        << bad;
  }
  http.stop();
}

TEST_F(Http, TakesHeadersLiterally) {
  EXPECT_EQ(status_of(ask("GET /healthz HTTP/1.1\r\nHost: localhost%00.evil.example\r\n\r\n")), 403);
  EXPECT_EQ(status_of(ask("GET /healthz HTTP/1.1\r\nHost: %6cocalhost\r\n\r\n")), 403);
  const std::string request = R"({"sweep": {"clearance_mm": [0.1]}})";
  for (const char* const key : {"kA", "k%41", "k%2541", "k%u0041"}) {
    for (int i = 0; i < 2; ++i)
      EXPECT_EQ(status_of(post("/v1/sweeps", request, std::string("Idempotency-Key: ") + key + "\r\n")), 201)
          << key;
  }
  EXPECT_EQ(sweep_count(), 4U) << "one for each key";
  EXPECT_EQ(status_of(post("/v1/sweeps", request,
                           "Origin: http://localhost\r\nContent-Type: application%2Fjson\r\n")),
            415);
  EXPECT_EQ(status_of(post("/v1/sweeps", request, "Origin: http://%6cocalhost\r\n")), 403);
  EXPECT_EQ(status_of(get("/v1/sweeps", "Sec-Fetch-Site: %6eone\r\n")), 403);
  EXPECT_EQ(status_of(post("/v1/sweeps", request, "Content-Encoding: %67zip\r\n")), 415);
  EXPECT_EQ(status_of(get("/", "If-None-Match: %2a\r\n")), 200);
  EXPECT_EQ(status_of(get("/", "If-None-Match: \"a\"\r\nIf-None-Match: *\r\n")), 304)
      << "two lines are one list";
  EXPECT_EQ(status_of(get("/", std::string("X: a") + '\0' + "b\r\n")), 400);
}

TEST(HttpToken, IsTakenLiterally) {
  Bench bench;
  HttpServer http(bench.routes(), {.address = "127.0.0.1", .port = 0, .token = "correct%41horse%2541battery"},
                  short_limits());
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
  EXPECT_EQ(status_with("Authorization: Bearer correct%41horse%2541battery\r\nAuthorization: Bearer a\r\n"),
            401);
  http.stop();
}

}  // namespace
}  // namespace server_tests
