// SPDX-License-Identifier: Apache-2.0
// Promises of the routes beyond their bodies: idempotency, conditional requests, waiting, forms of a table.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/context/long_poll_limit.h"
#include "server/context/work_limit.h"
#include "server/messages/preference.h"
#include "tests/server/service_fixture.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using server_tests::Bench;
using server_tests::endless_run;
using server_tests::header;
using server_tests::known_run;

const char* const kContractSweep = R"({"sweep": {"clearance_mm": [0.1, 0.2, 0.3]}})";

server::Request with_key(const std::string& path, const std::string& body, const std::string& key) {
  server::Request request{
      .method = "POST", .path = path, .query = {}, .accept = {}, .body = body, .id = "test-1"};
  request.idempotency_key = key;
  return request;
}

TEST(IdempotencyKey, GivesTheSameBytesAgain) {
  Bench bench;
  for (const std::string path : {"/v1/sweeps", "/v1/jobs"}) {
    const std::string body = path == "/v1/jobs" ? R"({"clearance_mm": 0.1})" : kContractSweep;
    const auto first = bench.call(with_key(path, body, "key-of" + path));
    const auto again = bench.call(with_key(path, body, "\"key-of" + path + "\""));
    EXPECT_EQ(first.status, 201);
    EXPECT_EQ(again.status, 201);
    EXPECT_EQ(again.body, first.body);
    EXPECT_EQ(header(again, "Location"), header(first, "Location"));
    EXPECT_EQ(bench.call(with_key(path, "{}", "key-of" + path)).status, 422);
  }
}

TEST(IdempotencyKey, HasToBeAKey) {
  Bench bench;
  for (const std::string& key :
       {std::string(), std::string("a b"), std::string("\x01"), std::string(256, 'k')}) {
    EXPECT_EQ(bench.call(with_key("/v1/sweeps", kContractSweep, key)).status, 400) << key;
  }
}

server::Response get_if_none_match(Bench& bench, const std::string& path, const std::string& tags) {
  server::Request request{
      .method = "GET", .path = path, .query = {}, .accept = {}, .body = {}, .id = "test-1"};
  request.if_none_match = tags;
  return bench.call(request);
}

TEST(ETag, SparesWhatTheClientHas) {
  Bench bench;
  const std::string id = bench.run(kContractSweep);
  const std::string job =
      json::parse(bench.call("GET", "/v1/sweeps/" + id + "/results").body)[0].at("job_id");
  for (const std::string& path :
       {"/v1/sweeps/" + id, "/v1/sweeps/" + id + "/results", "/v1/jobs/" + job,
        "/v1/jobs/" + job + "/trajectory", std::string("/"), std::string("/app.js")}) {
    const std::string tag = header(bench.call("GET", path), "ETag");
    ASSERT_FALSE(tag.empty()) << path;
    const auto spared = get_if_none_match(bench, path, "\"other\", W/" + tag);
    EXPECT_EQ(spared.status, 304) << path;
    EXPECT_TRUE(spared.body.empty());
    EXPECT_EQ(header(spared, "ETag"), tag);
    EXPECT_EQ(get_if_none_match(bench, path, "\"other\"").status, 200);
    EXPECT_EQ(get_if_none_match(bench, path, "*").status, 304);
  }
  const std::string results = "/v1/sweeps/" + id + "/results";
  EXPECT_NE(header(bench.call("GET", results), "ETag"),
            header(bench.call("GET", results, "", {{"format", "csv"}}), "ETag"));
}

TEST(ETag, GuardsWhatHasChangedSince) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(kContractSweep);
  const auto change = [&](const std::string& method, const std::string& at, const std::string& body,
                          const std::string& tags) {
    server::Request request{
        .method = method, .path = at, .query = {}, .accept = {}, .body = body, .id = "test-1"};
    request.if_match = tags;
    return bench.call(request);
  };
  const std::string seen = header(bench.call("GET", path), "ETag");
  EXPECT_EQ(change("PATCH", path, R"({"notes": "a colleague's"})", "\"other\", " + seen).status, 200);
  const auto late = change("PATCH", path, R"({"notes": "mine"})", seen);
  EXPECT_EQ(late.status, 412);
  EXPECT_EQ(json::parse(bench.call("GET", path).body).at("notes"), "a colleague's");
  const std::string now = header(bench.call("GET", path), "ETag");
  EXPECT_NE(late.body.find(json(now).dump().substr(1, 10)), std::string::npos) << late.body;
  EXPECT_EQ(change("POST", path + "/retry", "{}", seen).status, 412);
  EXPECT_EQ(change("DELETE", path, "", "W/" + now).status, 412) << "a weak tag names no state";
  EXPECT_EQ(change("DELETE", "/v1/sweeps/swp_1", "", "*").status, 404);
  EXPECT_EQ(change("DELETE", path, "", now).status, 204);
  Bench other(endless_run);
  const std::string running = "/v1/sweeps/" + other.submit(kContractSweep);
  server::Request cancel{
      .method = "POST", .path = running + "/cancel", .query = {}, .accept = {}, .body = {}, .id = "test-1"};
  for (const std::string& tags : {seen, ", " + seen, std::string(",")}) {
    cancel.if_match = tags;
    EXPECT_EQ(other.call(cancel).status, 412) << tags << ": it has no tag yet";
  }
  cancel.if_match = "*";
  EXPECT_EQ(other.call(cancel).status, 200);
}

TEST(ETag, GuardsAgainstChangesThatNameNone) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(kContractSweep);
  const auto ask = [&](const std::string& method, const std::string& body, const std::string& tag) {
    server::Request request{
        .method = method, .path = path, .query = {}, .accept = {}, .body = body, .id = "test-1"};
    request.if_match = tag;
    return bench.routes().answer(request);
  };
  const std::jthread colleague([&](const std::stop_token& stop) {
    for (int k = 0; !stop.stop_requested(); ++k) {
      EXPECT_EQ(ask("PATCH", R"({"notes": ")" + std::to_string(k) + R"("})", "").status, 200);
      std::this_thread::sleep_for(10ms);
    }
  });
  int changes = 0;
  for (int tries = 0; tries < 3000 && changes < 100; ++tries) {
    const auto seen = ask("GET", "", "");
    const std::string tags = R"({"tags": [")" + std::to_string(tries) + R"("]})";
    const auto changed = ask("PATCH", tags, header(seen, "ETag"));
    if (changed.status == 412) continue;
    ++changes;
    ASSERT_EQ(json::parse(changed.body).at("notes"), json::parse(seen.body).at("notes"))
        << "the colleague's change came between the look and the change";
  }
  EXPECT_GT(changes, 0);
}

/// Waits until a service answers that it is full. False after some seconds.
bool wait_until_full(Bench& bench) {
  for (int k = 0; k < 200; ++k) {
    if (json::parse(bench.call("GET", "/readyz").body).at("status") == "full") return true;
    std::this_thread::sleep_for(50ms);
  }
  return false;
}

TEST(StoreLimit, IsSeenFromOutside) {
  Bench bench(known_run, {.most_bytes = 450'000});
  const std::string request = R"({"sweep": {"crank_velocity_rad_s": {"from": 1, "to": 2, "count": 60}}})";
  const std::string id = bench.submit(request);
  ASSERT_TRUE(wait_until_full(bench));
  const json sweep = json::parse(bench.call("GET", "/v1/sweeps/" + id).body);
  EXPECT_EQ(sweep.at("state"), "running");
  EXPECT_TRUE(sweep.at("eta_s").is_null());
  const json executors = json::parse(bench.call("GET", "/v1/executors").body);
  EXPECT_NE(executors.at("items")[0].at("problems").dump().find("results wait to be stored"),
            std::string::npos);
  // A dry run is refused as the submission would be.
  const std::string large = R"({"sweep": {"clearance_mm": {"from": 0.1, "to": 0.4, "count": 5000}}})";
  EXPECT_EQ(bench.call("POST", "/v1/sweeps", large).status, 507);
  EXPECT_EQ(bench.call("POST", "/v1/sweeps", large, {{"dry_run", "true"}}).status, 507);
  EXPECT_EQ(json::parse(bench.call("GET", "/v1/sweeps").body).at("items").size(), 1U);
  // Room is used as soon as there is some.
  EXPECT_EQ(bench.call("POST", "/v1/sweeps/" + id + "/cancel", "{}").status, 200);
  EXPECT_EQ(bench.call("DELETE", "/v1/sweeps/" + id).status, 204);
  const std::string small = R"({"sweep": {"crank_velocity_rad_s": [7]}})";
  const json estimate = json::parse(bench.call("POST", "/v1/sweeps", small, {{"dry_run", "true"}}).body);
  EXPECT_LT(estimate.at("free_bytes"), 450'000);
  EXPECT_GT(estimate.at("free_bytes"), 0);
  bench.run(small);
  EXPECT_EQ(json::parse(bench.call("GET", "/readyz").body).at("status"), "ready");
}

TEST(ETag, IsNotOfWhatStillChanges) {
  Bench bench(endless_run);
  const std::string id = bench.submit(kContractSweep);
  for (const std::string& path : {"/v1/sweeps/" + id, "/v1/sweeps/" + id + "/results"}) {
    const auto response = bench.call("GET", path);
    EXPECT_EQ(header(response, "ETag"), "");
    EXPECT_EQ(header(response, "Cache-Control"), "no-store");
    EXPECT_EQ(get_if_none_match(bench, path, "*").status, 200);
  }
}

TEST(Prefer, IsReadFromItsList) {
  EXPECT_EQ(server::find_wait("respond-async, wait=10"), 10s);
  EXPECT_EQ(server::find_wait("wait = 5"), 5s);
  EXPECT_EQ(server::find_wait("Wait=5"), 5s);
  EXPECT_EQ(server::find_wait("wait=100000"), 60s);
  for (const char* none : {"", "wait", "wait=", "wait=-1", "wait=1.5", "waiting=3", "handling=lenient"})
    EXPECT_FALSE(server::find_wait(none).has_value()) << none;
}

TEST(Prefer, WaitsForTheEndOfASweep) {
  Bench bench;
  server::Request request{.method = "POST",
                          .path = "/v1/sweeps",
                          .query = {},
                          .accept = {},
                          .body = kContractSweep,
                          .id = "test-1"};
  request.prefer = "wait=20";
  const auto created = bench.call(request);
  EXPECT_EQ(created.status, 201);
  EXPECT_EQ(json::parse(created.body).at("state"), "succeeded");
  EXPECT_EQ(header(created, "Preference-Applied"), "wait=20");
}

TEST(Prefer, WaitsForTheEndOfAJob) {
  Bench bench;
  server::Request request{
      .method = "POST", .path = "/v1/jobs", .query = {}, .accept = {}, .body = "{}", .id = "test-1"};
  request.prefer = "wait=20";
  const auto created = bench.call(request);
  EXPECT_EQ(created.status, 201);
  EXPECT_EQ(json::parse(created.body).at("state"), "succeeded");
  EXPECT_EQ(header(created, "Preference-Applied"), "wait=20");
  request.body = R"({"clearance_mm": 0.3})";
  request.prefer = "";
  const std::string place = header(bench.call(request), "Location");
  server::Request again{
      .method = "GET", .path = place, .query = {}, .accept = {}, .body = {}, .id = "test-1"};
  again.prefer = "wait=20";
  const auto found = bench.call(again);
  EXPECT_EQ(json::parse(found.body).at("state"), "succeeded");
  EXPECT_EQ(header(found, "Preference-Applied"), "wait=20");
}

TEST(Prefer, WaitsNoLongerThanItIsTold) {
  Bench bench(endless_run);
  const std::string id = bench.submit(kContractSweep);
  server::Request request{
      .method = "GET", .path = "/v1/sweeps/" + id, .query = {}, .accept = {}, .body = {}, .id = "test-1"};
  request.prefer = "wait=1";
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(json::parse(bench.call(request).body).at("state"), "running");
  EXPECT_GE(std::chrono::steady_clock::now() - start, 1s);
  const std::string job =
      json::parse(bench.call("GET", "/v1/sweeps/" + id + "/results").body)[0].at("job_id");
  request.path = "/v1/jobs/" + job;
  EXPECT_EQ(json::parse(bench.call(request).body).at("state"), "running");
  EXPECT_GE(std::chrono::steady_clock::now() - start, 2s);
}

TEST(Prefer, LeavesThreadsToOthers) {
  Bench bench(endless_run);
  const std::string id = bench.submit(kContractSweep);
  server::WorkLimit places(20, 0);
  server::LongPollLimit room(places);
  server::Request request{};
  request.prefer = "wait=60";
  const auto wait = [&] {
    server::Response response{};
    return room.wait(request, response,
                     [&](std::chrono::seconds time) { bench.service().wait_for_sweep(id, time); });
  };
  std::vector<std::jthread> waiting;
  for (int k = 0; k < 8; ++k) waiting.emplace_back([&] { EXPECT_TRUE(wait()); });
  std::this_thread::sleep_for(200ms);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(wait());
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
  bench.service().stop();  // ends all waiting
}

TEST(Prefer, IsNotAppliedWhereTooManyWaitForOtherThings) {
  server::WorkLimit places(1, 0);
  server::LongPollLimit room(places);
  server::Request request{};
  request.prefer = "wait=60";
  server::Response response{};
  auto place = places.acquire();
  EXPECT_FALSE(room.wait(request, response, [](std::chrono::seconds) {}));
  place.reset();
  EXPECT_TRUE(room.wait(request, response, [](std::chrono::seconds) {}));
}

TEST(Prefer, FreesThePlaceOfAWaitThatFailed) {
  server::WorkLimit places(20, 0);
  server::LongPollLimit room(places);
  server::Request request{};
  request.prefer = "wait=60";
  server::Response response{};
  constexpr int kMoreThanThereArePlaces = 9;
  for (int k = 0; k < kMoreThanThereArePlaces; ++k) {
    EXPECT_THROW(
        room.wait(request, response,
                  [](std::chrono::seconds) { throw std::runtime_error("the store cannot be read"); }),
        std::runtime_error);
  }
  EXPECT_TRUE(room.wait(request, response, [](std::chrono::seconds) {}));
}

TEST(Prefer, HoldsNoPermitForLargeWork) {
  Bench bench(endless_run);
  const std::string id = bench.submit(kContractSweep);
  server::Request large{.method = "POST",
                        .path = "/v1/sweeps",
                        .query = {},
                        .accept = {},
                        .body = kContractSweep + std::string(100'000, ' '),
                        .id = "test-1"};
  large.prefer = "wait=60";
  std::vector<std::jthread> waiting;
  for (int k = 0; k < 3; ++k)
    waiting.emplace_back([&] { EXPECT_EQ(bench.routes().answer(large).status, 201); });
  std::this_thread::sleep_for(500ms);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(bench.call("GET", "/v1/sweeps/" + id + "/results").status, 200);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);
  bench.service().stop();  // ends all waiting
}

TEST(GetResults, TakesFieldsFiltersAndOrder) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(kContractSweep) + "/results";
  const auto rows =
      bench.call("GET", path, "",
                 {{"fields", "clearance_mm"}, {"order_by", "-clearance_mm"}, {"clearance_mm_lt", "0.3"}});
  EXPECT_EQ(json::parse(rows.body), json::parse(R"([{"clearance_mm": 0.2}, {"clearance_mm": 0.1}])"));
  EXPECT_EQ(
      bench.call("GET", path, "", {{"fields", "clearance_mm"}, {"limit", "1"}, {"format", "ndjson"}}).body,
      "{\"clearance_mm\":0.1}\n");
  EXPECT_EQ(bench.call("GET", path, "", {{"clearance_mm_gt", "1"}, {"format", "ndjson"}}).body, "");
  const auto faulty = bench.call("GET", path, "", {{"fields", ""}, {"limit", "-1"}});
  EXPECT_EQ(json::parse(faulty.body).at("errors").size(), 2U);
  EXPECT_EQ(bench.call("GET", path, "", {{"clearance_mm_gt", "much"}}).status, 422);
}

/// The places of all faults of an answer, with blanks between.
std::string pointers_of(const server::Response& answer) {
  std::string pointers;
  const json problem = json::parse(answer.body);  // must outlive the loop
  for (const json& error : problem.at("errors"))
    pointers += (pointers.empty() ? "" : " ") + error.at("pointer").get<std::string>();
  return pointers;
}

TEST(Query, IsRefusedWithFaultsOfFormAndOfMeaningAtOnce) {
  Bench bench;
  const std::string results = "/v1/sweeps/" + bench.run(kContractSweep) + "/results";
  const std::string job = json::parse(bench.call("GET", results).body)[0].at("job_id");
  EXPECT_EQ(pointers_of(bench.call("GET", results, "",
                                   {{"limit", "x"}, {"fields", "nope"}, {"clearance_mm_gt", "much"}})),
            "/limit /clearance_mm_gt /fields/0");
  EXPECT_EQ(
      pointers_of(bench.call("GET", "/v1/jobs/" + job + "/trajectory", "",
                             {{"format", "xml"}, {"channels", "t_s,,nope"}, {"from", "1"}, {"to", "0"}})),
      "/format /channels/1 /channels/2 /to");
  for (const char* const list : {"/v1/sweeps", "/v1/jobs"}) {
    EXPECT_EQ(pointers_of(bench.call(
                  "GET", list, "", {{"limit", "x"}, {"state", "lost"}, {"cursor", "c"}, {"fields", "nope"}})),
              "/limit /cursor /state /fields/0");
  }
}

TEST(GetResults, TakesTheFormThatIsAcceptedFirst) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(kContractSweep) + "/results";
  EXPECT_EQ(bench.call("GET", path, "", {}, "application/x-ndjson, */*").content_type,
            "application/x-ndjson");
  EXPECT_EQ(bench.call("GET", path, "", {}, "application/json, text/csv").content_type, "application/json");
  EXPECT_EQ(bench.call("GET", path, "", {{"format", "npz"}}).status, 422);
}

TEST(GetTrajectory, IsAFileOfNumPy) {
  Bench bench;
  const std::string id = bench.run(R"({"sweep": {"clearance_mm": [0.1]}})");
  const std::string job =
      json::parse(bench.call("GET", "/v1/sweeps/" + id + "/results").body)[0].at("job_id");
  const auto npz = bench.call("GET", "/v1/jobs/" + job + "/trajectory", "", {{"format", "npz"}});
  EXPECT_EQ(npz.body.substr(0, 2), "PK");
  EXPECT_NE(header(npz, "Content-Disposition").find(".npz\""), std::string::npos);
  EXPECT_EQ(bench
                .call("GET", "/v1/jobs/" + job + "/trajectory", "",
                      {{"points", "3"}, {"channels", "slider_position_m"}})
                .status,
            422);
  const auto few = bench.call("GET", "/v1/jobs/" + job + "/trajectory", "",
                              {{"points", "4"}, {"channels", "slider_position_m"}});
  EXPECT_EQ(json::parse(few.body).at("columns").at("t_s").size(), 4U);
}

TEST(RetryAndExtend, AnswerWithTheSweep) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(kContractSweep);
  EXPECT_EQ(json::parse(bench.call("POST", path + "/retry").body).at("counts").at("succeeded"), 3);
  const auto extended = bench.call("POST", path + "/extend", R"({"sweep": {"clearance_mm": [0.4]}})");
  EXPECT_EQ(extended.status, 200);
  EXPECT_EQ(json::parse(extended.body).at("counts").at("total"), 4);
  EXPECT_EQ(bench.call("POST", path + "/extend", "{}").status, 422);
  EXPECT_EQ(bench.call("POST", path + "/extend", "").status, 400);
  EXPECT_EQ(bench.call("POST", "/v1/sweeps/swp_none/extend", "{}").status, 404);
  EXPECT_EQ(bench.call("POST", "/v1/sweeps/swp_none/retry").status, 404);
}

TEST(GetStore, IsAFileThatNobodyElseSees) {
  Bench bench;
  (void)bench.run(kContractSweep);
  const auto copy = bench.call("GET", "/v1/store");
  EXPECT_EQ(copy.status, 200);
  EXPECT_EQ(copy.content_type, "application/vnd.sqlite3");
  ASSERT_NE(copy.file, nullptr);
  std::string start(16, '\0');
  EXPECT_EQ(copy.file->read(0, start.data(), start.size()), start.size());
  EXPECT_EQ(start, std::string("SQLite format 3") + '\0');
  EXPECT_FALSE(std::filesystem::exists(bench.service().store_file().string() + ".rpsup-copy"));
  EXPECT_EQ(bench.call("GET", "/v1/store", "", {{"format", "csv"}}).status, 422);
}

TEST(GetStore, HasOneCopyOnTheDiskAtATime) {
  Bench bench;
  auto copy = bench.call("GET", "/v1/store");
  ASSERT_EQ(copy.status, 200);
  const auto second = bench.call("GET", "/v1/store");
  EXPECT_EQ(second.status, 503) << "while the first is being sent";
  EXPECT_NE(header(second, "Retry-After"), "");
  copy.file.reset();
  EXPECT_EQ(bench.call("GET", "/v1/store").status, 200);
}

TEST(GetStore, LeavesNoCopyOfAProcessThatDied) {
  Bench bench;
  const std::filesystem::path left = bench.service().store_file().string() + ".rpsup-copy";
  std::ofstream(left) << "half of it";
  const server::Routes next_process(bench.service());
  EXPECT_FALSE(std::filesystem::exists(left));
}

}  // namespace
