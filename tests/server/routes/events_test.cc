// SPDX-License-Identifier: Apache-2.0
#include "server/routes/events.h"

#include <array>
#include <chrono>
#include <list>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/http/event_hub.h"
#include "server/http/http.h"
#include "server/http/http_limits.h"
#include "tests/server/http/raw_client.h"
#include "tests/server/service_fixture.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using server_tests::Bench;
using server_tests::body_of;
using server_tests::endless_run;
using server_tests::RawClient;
using server_tests::status_of;

const char* const kSweep = R"({"sweep": {"clearance_mm": [0.1, 0.2, 0.3]}})";

/// Values of the lines `name: value` of a text.
std::vector<std::string> event_lines_of(const std::string& text, const std::string& name) {
  std::vector<std::string> values;
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string line = text.substr(start, end - start);
    if (line.starts_with(name + ": ")) values.push_back(line.substr(name.size() + 2));
    start = end + 1;
  }
  return values;
}

server::Response follow_path(Bench& bench, const std::string& path, const std::string& last_event_id) {
  server::Request request{
      .method = "GET", .path = path + "/events", .query = {}, .accept = {}, .body = {}, .id = "test-1"};
  request.last_event_id = last_event_id;
  return bench.call(request);
}

server::Response follow(Bench& bench, const std::string& id, const std::string& last_event_id = "") {
  return follow_path(bench, "/v1/sweeps/" + id, last_event_id);
}

TEST(SweepEvents, TellOfEveryJobThenOfTheEnd) {
  Bench bench;
  const std::string id = bench.run(kSweep);
  const auto response = follow(bench, id);
  EXPECT_EQ(response.content_type, "text/event-stream");
  const std::string text = response.events->next();
  EXPECT_EQ(event_lines_of(text, "event"),
            (std::vector<std::string>{"job", "job", "job", "progress", "done"}));
  EXPECT_TRUE(response.events->has_ended());
  for (const std::string& data : event_lines_of(text, "data")) EXPECT_TRUE(json::accept(data));
  EXPECT_EQ(json::parse(event_lines_of(text, "data").back()).at("state"), "succeeded");
}

TEST(SweepEvents, GoOnAfterTheLastOneThatTheClientHas) {
  Bench bench;
  const std::string id = bench.run(kSweep);
  const std::string all = follow(bench, id).events->next();
  const auto ids = event_lines_of(all, "id");
  ASSERT_EQ(ids.size(), 4U);
  const std::string rest = follow(bench, id, ids[0]).events->next();
  EXPECT_EQ(event_lines_of(rest, "event"), (std::vector<std::string>{"job", "job", "progress", "done"}));
  EXPECT_EQ(event_lines_of(follow(bench, id, ids[2]).events->next(), "event"),
            (std::vector<std::string>{"progress", "done"}));
  EXPECT_EQ(follow(bench, id, ids[3]).status, 204);
  bench.call("POST", "/v1/sweeps/" + id + "/extend", R"({"sweep": {"clearance_mm": [0.4]}})");
  ASSERT_TRUE(bench.service().wait_for_sweep(id, 300s));
  EXPECT_EQ(event_lines_of(follow(bench, id, ids[3]).events->next(), "event"),
            (std::vector<std::string>{"job", "progress", "done"}));
}

TEST(SweepEvents, AreSilentWhileNothingHappens) {
  Bench bench(endless_run);
  const std::string id = bench.submit(kSweep);
  while (json::parse(bench.call("GET", "/v1/sweeps/" + id).body).at("counts").at("running") == 0)
    std::this_thread::sleep_for(5ms);
  const auto response = follow(bench, id);
  EXPECT_EQ(event_lines_of(response.events->next(), "event"), (std::vector<std::string>{"progress"}));
  EXPECT_EQ(response.events->next(), "");
  bench.call("POST", "/v1/sweeps/" + id + "/cancel");
  const std::string text = response.events->next();
  // Jobs that ended together have one id, at the last of them.
  EXPECT_EQ(event_lines_of(text, "event"),
            (std::vector<std::string>{"job", "job", "job", "progress", "done"}));
  EXPECT_EQ(event_lines_of(text, "id").size(), 2U);
  EXPECT_LT(text.find("event: job"), text.find("id: "));
}

TEST(SweepEvents, RefuseWhatTheyDoNotKnow) {
  Bench bench;
  const std::string id = bench.run(kSweep);
  for (const char* place : {"x", "-1", "1x", "-done", "99999999999999999999"})
    EXPECT_EQ(follow(bench, id, place).status, 400) << place;
  EXPECT_EQ(follow(bench, "swp_none").status, 404);
}

struct StudyCase {
  const char* path;
  const char* request;
};

class StudyEvents : public testing::TestWithParam<StudyCase> {
 protected:
  /// Submits the study, and gives its path.
  static std::string submit(Bench& bench, const std::string& prefer = "") {
    server::Request request{.method = "POST",
                            .path = GetParam().path,
                            .query = {},
                            .accept = {},
                            .body = GetParam().request,
                            .id = "test-1"};
    request.prefer = prefer;
    const auto created = bench.call(request);
    EXPECT_EQ(created.status, 201) << created.body;
    if (!prefer.empty()) {
      EXPECT_EQ(json::parse(created.body).at("state"), "succeeded") << "it was waited for";
      EXPECT_EQ(server_tests::header(created, "Preference-Applied"), prefer);
    }
    return server_tests::header(created, "Location");
  }
};

TEST_P(StudyEvents, TellOfEveryJobThenOfTheEndAndAreResumed) {
  Bench bench;
  const std::string path = submit(bench, "wait=20");
  const json study = json::parse(bench.call("GET", path).body);
  EXPECT_EQ(study.at("links").at("events"), path + "/events");
  const auto jobs = study.at("counts").at("succeeded").get<std::size_t>();
  const std::string all = follow_path(bench, path, "").events->next();
  const auto events = event_lines_of(all, "event");
  ASSERT_EQ(events.size(), jobs + 2);
  EXPECT_EQ(events[jobs], "progress");
  EXPECT_EQ(events.back(), "done");
  const json last = json::parse(event_lines_of(all, "data").back());
  EXPECT_EQ(last, (json{{"id", study.at("id")},
                        {"sweep_id", study.at("sweep_id")},
                        {"state", "succeeded"},
                        {"counts", study.at("counts")},
                        {"progress", 1.0}}));
  const auto ids = event_lines_of(all, "id");
  EXPECT_LT(event_lines_of(follow_path(bench, path, ids[0]).events->next(), "event").size(), events.size());
  EXPECT_EQ(follow_path(bench, path, ids.back()).status, 204);
  EXPECT_EQ(follow_path(bench, path, "x").status, 400);
  EXPECT_EQ(follow_path(bench, path + "x", "").status, 404);
}

TEST_P(StudyEvents, EndOnlyWithTheStudy) {
  Bench bench(endless_run);
  const std::string path = submit(bench);
  const auto response = follow_path(bench, path, "");
  const std::string first = response.events->next();
  EXPECT_EQ(event_lines_of(first, "event"), (std::vector<std::string>{"progress"}));
  EXPECT_EQ(json::parse(event_lines_of(first, "data").back()).at("state"), "running");
  EXPECT_FALSE(response.events->has_ended());
  bench.call("POST", path + "/cancel");
  std::string rest;
  for (int tries = 0; tries < 1000 && !response.events->has_ended(); ++tries) {
    rest += response.events->next();
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_EQ(event_lines_of(rest, "event").back(), "done");
  EXPECT_EQ(json::parse(event_lines_of(rest, "data").back()).at("state"), "cancelled");
}

std::string name_of_study(const testing::TestParamInfo<StudyCase>& study) {
  constexpr std::array<const char*, 3> kNames{"Search", "WearStudy", "Optimisation"};
  return kNames.at(study.index);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, StudyEvents,
    testing::Values(
        StudyCase{"/v1/searches", R"({"over": {"clearance_mm": {"from": 0.1, "to": 0.9, "tolerance": 0.02}},
                                                  "metric": "peak_slider_acceleration_m_s2",
                                     "bound": 0.53})"},
        StudyCase{"/v1/wear-studies",
                  R"({"parameters": {"duration_s": 1, "run_up_s": 0}, "worn_clearance_mm": 0.253})"},
        StudyCase{"/v1/optimisations", R"({"over": {"clearance_mm": {"from": 0.1, "to": 0.9}},
                                           "objectives": [{"metric": "peak_slider_acceleration_m_s2"}]})"}),
    name_of_study);

class EventsOverHttp : public testing::Test {
 protected:
  static constexpr std::chrono::milliseconds kResponseTime{500};

  EventsOverHttp()
      : http_(bench_.routes(), {.address = "127.0.0.1", .port = 0}, {.response_time = kResponseTime}),
        port_(http_.bind()) {
    listener_ = std::jthread([this] { http_.listen(); });
    id_ = bench_.submit(kSweep);
  }
  ~EventsOverHttp() override { http_.stop(); }

  void send_request(RawClient& client) const {
    client.send("GET /v1/sweeps/" + id_ + "/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }

  Bench bench_{endless_run};
  server::HttpServer http_;
  int port_;
  std::string id_;
  std::jthread listener_;
};

TEST_F(EventsOverHttp, ArriveAsTheyHappen) {
  RawClient client(port_);
  send_request(client);
  ASSERT_TRUE(client.answered_within(60s));
  bench_.call("POST", "/v1/sweeps/" + id_ + "/cancel");
  const std::string answer = client.read_all();
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_NE(answer.find("Content-Type: text/event-stream\r\n"), std::string::npos);
  EXPECT_EQ(answer.find("Content-Length"), std::string::npos);
  EXPECT_EQ(event_lines_of(body_of(answer), "event").back(), "done");
}

TEST_F(EventsOverHttp, GoOnForLongerThanAnAnswerMayTake) {
  RawClient client(port_);
  send_request(client);
  ASSERT_TRUE(client.answered_within(60s));
  std::this_thread::sleep_for(2 * kResponseTime);
  bench_.call("POST", "/v1/sweeps/" + id_ + "/cancel");
  EXPECT_EQ(event_lines_of(body_of(client.read_all()), "event").back(), "done");
}

TEST_F(EventsOverHttp, TakeNoThreadFromOthersAndHaveABound) {
  std::list<RawClient> clients;
  for (std::size_t k = 0; k < server::EventHub::kMaxStreams; ++k) {
    send_request(clients.emplace_back(port_));
    ASSERT_TRUE(clients.back().answered_within(60s)) << k;
  }
  RawClient other(port_);
  other.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(other.read_all()), 200);
  RawClient one_more(port_);
  send_request(one_more);
  const std::string refusal = one_more.read_all();
  EXPECT_EQ(status_of(refusal), 503);
  EXPECT_NE(refusal.find("Retry-After:"), std::string::npos);
  // A client that leaves makes room.
  clients.pop_front();
  int status = 503;
  for (int tries = 0; tries < 100 && status == 503; ++tries) {
    std::this_thread::sleep_for(50ms);
    RawClient again(port_);
    send_request(again);
    ASSERT_TRUE(again.answered_within(60s));
    status = again.read_status();
  }
  EXPECT_EQ(status, 200);
}

TEST_F(EventsOverHttp, EndWithTheServer) {
  RawClient client(port_);
  send_request(client);
  ASSERT_TRUE(client.answered_within(60s));
  const auto start = std::chrono::steady_clock::now();
  http_.stop();
  const std::string answer = client.read_all();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 3s);
  EXPECT_EQ(answer.find("no end of the connection"), std::string::npos);
}

TEST_F(EventsOverHttp, HaveNoneForHead) {
  RawClient client(port_);
  client.send("HEAD /v1/sweeps/" + id_ + "/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string answer = client.read_all();
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(body_of(answer), "");
}

}  // namespace
