// SPDX-License-Identifier: Apache-2.0
#include "server/routes/routes.h"

#include <algorithm>
#include <cstddef>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "jobs/base/program_info.h"
#include "server/context/route.h"
#include "server/messages/identifiers.h"
#include "server/routes/route_table.h"
#include "tests/server/service_fixture.h"

namespace {

using nlohmann::json;
using server_tests::Bench;
using server_tests::header;

TEST(Routes, AnswerUnknownPathsWith404) {
  Bench bench;
  for (const char* const path :
       {"/nothing", "/nothing/", "/v1", "/v1/", "/v1/sweeps/a/b", "/v1/sweeps//results", "/v1/sweeps/a b",
        "//", "/../server/main.cc"}) {
    const auto response = bench.call("GET", path);
    EXPECT_EQ(response.status, 404) << path;
    EXPECT_EQ(response.content_type, "application/problem+json") << path;
  }
}

TEST(Routes, AnswerAnIdThatIsTooLongWith404) {
  Bench bench;
  EXPECT_EQ(bench.call("GET", "/v1/sweeps/" + std::string(65, 'a')).status, 404);
  EXPECT_FALSE(server::is_id(std::string(65, 'a')));
  EXPECT_TRUE(server::is_id(std::string(64, 'a')));
  EXPECT_FALSE(server::is_id("a.b"));
}

TEST(Routes, AnswerOtherMethodsWith405AndAllow) {
  Bench bench;
  struct Case {
    const char* method;
    const char* path;
    const char* allow;
  };
  for (const Case& c :
       {Case{"PUT", "/v1/sweeps", "POST, GET, HEAD"}, Case{"POST", "/v1/sweeps/a", "GET, HEAD, PATCH, DELETE"},
        Case{"GET", "/v1/sweeps/a/cancel", "POST"}, Case{"OPTIONS", "/", "GET, HEAD"}}) {
    const auto response = bench.call(c.method, c.path);
    EXPECT_EQ(response.status, 405) << c.path;
    EXPECT_EQ(header(response, "Allow"), c.allow) << c.path;
  }
}

TEST(Routes, AnswerHeadLikeGet) {
  Bench bench;
  EXPECT_EQ(bench.call("HEAD", "/healthz").status, 200);
  EXPECT_EQ(bench.call("HEAD", "/v1/sweeps/a").status, 404);
}

TEST(Routes, ServeThePage) {
  Bench bench;
  const auto page = bench.call("GET", "/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
  // Whatever the page asks for is there, and nothing in it needs more than the policy of the server allows.
  const std::regex reference(R"re((?:src|href)="([^"#:]+)")re");
  std::vector<std::string> parts;
  for (std::sregex_iterator each(page.body.begin(), page.body.end(), reference), end; each != end; ++each)
    parts.push_back((*each)[1]);
  // Relative, since a proxy may show the service under a path.
  EXPECT_NE(std::find(parts.begin(), parts.end(), "app.js"), parts.end());
  for (const std::string& part : parts) EXPECT_EQ(bench.call("GET", "/" + part).status, 200) << part;
  EXPECT_EQ(page.body.find("style="), std::string::npos);
  EXPECT_EQ(page.body.find("onclick"), std::string::npos);
  EXPECT_EQ(page.body.find("<script>"), std::string::npos);
  const auto script = bench.call("GET", "/app.js");
  EXPECT_EQ(script.content_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(script.body.find("innerHTML"), std::string::npos);
  EXPECT_EQ(header(bench.call("POST", "/app.js"), "Allow"), "GET, HEAD");
}

TEST(Routes, AreHealthyAndReady) {
  Bench bench;
  EXPECT_EQ(json::parse(bench.call("GET", "/healthz").body),
            (json{{"status", "ok"}, {"version", jobs::kProgramVersion}}));
  EXPECT_EQ(json::parse(bench.call("GET", "/readyz").body), json::parse(R"({"status": "ready"})"));
}

TEST(Routes, TakeNothingNewWhileDraining) {
  Bench bench;
  const std::string id = bench.run(R"({"sweep": {"clearance_mm": [0.1]}})");
  bench.routes().start_draining();
  for (const auto& response :
       {bench.call("POST", "/v1/sweeps", "{}"), bench.call("POST", "/v1/jobs", "{}"),
        bench.call("DELETE", "/v1/sweeps/" + id), bench.call("GET", "/readyz")}) {
    EXPECT_EQ(response.status, 503);
    EXPECT_FALSE(header(response, "Retry-After").empty());
  }
  EXPECT_EQ(bench.call("GET", "/v1/sweeps/" + id).status, 200);
  EXPECT_EQ(bench.call("GET", "/healthz").status, 200);
}

TEST(Routes, ComputeLargeAnswersAFewAtATime) {
  std::string light;
  for (const server::Route& route : server::route_table())
    if (route.method == "GET" && !server::is_heavy(route, {})) light += route.pattern + " ";
  EXPECT_EQ(light,
            "/v1/sweeps /v1/sweeps/{id} /v1/sweeps/{id}/events /v1/searches /v1/searches/{id}/events "
            "/v1/wear-studies /v1/wear-studies/{id}/events /v1/optimisations /v1/optimisations/{id}/events "
            "/v1/fits /v1/fits/{id}/events /v1/jobs /v1/jobs/{id} /v1/measurements /v1/measurements/{id} "
            "/v1/parameters /v1/executors /v1/openapi.json /docs /docs/docs.js /docs/swagger-ui-bundle.js "
            "/docs/swagger-ui.css /v1/store /metrics /healthz /readyz / ");
  for (const auto& [limit, heavy] :
       {std::pair{"1000", false}, {"1001", true}, {"10000", true}, {"x", false}}) {
    server::Request page{};
    page.query = {{"limit", limit}};
    EXPECT_EQ(server::is_heavy(server::Route{}, page), heavy) << limit;
  }
  for (const std::size_t bytes : {65'536U, 65'537U}) {
    server::Request submission{};
    submission.body = std::string(bytes, ' ');
    EXPECT_EQ(server::is_heavy(server::Route{}, submission), bytes > 65'536U) << bytes;
  }
}

TEST(Routes, HaveAFewLargeAnswersSentAtATime) {
  Bench bench(server_tests::endless_run);
  server::Request request{};
  request.method = "GET";
  request.path = "/v1/sweeps/" +
                 bench.submit(R"({"sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 10000}}})") +
                 "/results";
  std::vector<server::Response> sent;
  for (int k = 0; k < 8; ++k) {
    sent.push_back(bench.routes().answer(request));
    ASSERT_EQ(sent.back().status, 200) << k;
    ASSERT_GT(sent.back().body.size(), 1'048'576U);
  }
  const auto one_more = bench.routes().answer(request);
  EXPECT_EQ(one_more.status, 503);
  EXPECT_FALSE(header(one_more, "Retry-After").empty());
  request.query = {{"limit", "5"}};
  EXPECT_EQ(bench.routes().answer(request).status, 200) << "a small one";
  request.query = {};
  sent.pop_back();
  EXPECT_EQ(bench.routes().answer(request).status, 200);
}

// Requests let in before the service begins to end, and handled after its end.
TEST(Routes, TakeNothingNewOnceTheServiceIsStopped) {
  Bench bench;
  bench.service().stop();
  for (const auto& response :
       {bench.call("POST", "/v1/sweeps", "{}"), bench.call("POST", "/v1/jobs", "{}")}) {
    EXPECT_EQ(response.status, 503);
    EXPECT_FALSE(header(response, "Retry-After").empty());
  }
}

}  // namespace
