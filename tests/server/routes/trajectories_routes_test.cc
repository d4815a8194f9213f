// SPDX-License-Identifier: Apache-2.0
// Files with all trajectories of a sweep.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/measurements/zip_archive.h"
#include "tests/server/service_fixture.h"

namespace server_tests {
namespace {

using nlohmann::json;
using Pairs = std::vector<std::pair<std::string, std::string>>;

std::string make_sweep(Bench& bench) {
  return bench.run(R"({"sweep": {"clearance_mm": [0.1, 0.2], "coupler": ["rigid", "flexible"]}})");
}

std::string bytes_of(const server::Response& response) {
  std::string bytes(response.file->size(), '\0');
  EXPECT_EQ(response.file->read(0, bytes.data(), bytes.size()), bytes.size());
  return bytes;
}

server::Response fetch(Bench& bench, const std::string& id, Pairs query, const std::string& range = "",
                       const std::string& if_range = "") {
  server::Request request{"GET", "/v1/sweeps/" + id + "/trajectories", std::move(query), "", "", "test-1"};
  request.range = range;
  request.if_range = if_range;
  return bench.call(request);
}

TEST(GetTrajectories, GivesEachFormatTheSameBytesAgain) {
  Bench bench;
  const std::string id = make_sweep(bench);
  const std::vector<std::pair<std::string, std::string>> starts{
      {"h5", "\x89HDF"}, {"mat", "MATLAB 5.0 MAT-file, rpsup"}, {"npz", "PK\x03\x04"}};
  for (const auto& [format, start] : starts) {
    const auto first = fetch(bench, id, {{"format", format}});
    ASSERT_EQ(first.status, 200) << format << first.body;
    EXPECT_EQ(bytes_of(first).substr(0, start.size()), start);
    EXPECT_EQ(header(first, "Content-Disposition"),
              "attachment; filename=\"sweep-" + id + "." + format + "\"");
    EXPECT_EQ(header(first, "Accept-Ranges"), "bytes");
    const auto second = fetch(bench, id, {{"format", format}});
    EXPECT_EQ(header(first, "ETag"), header(second, "ETag"));
    EXPECT_EQ(bytes_of(first), bytes_of(second)) << format;
  }
}

TEST(GetTrajectories, TakesTheFormatOfTheAcceptHeader) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + make_sweep(bench) + "/trajectories";
  EXPECT_EQ(bench.call("GET", path).content_type, "application/x-hdf5");
  EXPECT_EQ(bench.call("GET", path, "", {}, "application/x-npz").content_type, "application/x-npz");
  EXPECT_EQ(bench.call("GET", path, "", {{"format", "mat"}}, "application/x-npz").content_type,
            "application/x-matlab-data");
}

TEST(GetTrajectories, HoldsTheWantedChannelsOfTheWantedTimes) {
  Bench bench;
  const std::string id = make_sweep(bench);
  const auto answer = fetch(bench, id,
                            {{"format", "npz"},
                             {"channels", "slider_velocity_m_s,pose_1_3_1_x_m"},
                             {"from", "0.001"},
                             {"to", "0.002"}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  std::vector<std::string> names;
  const std::string bytes = bytes_of(answer);
  for (const auto& entry : jobs::read_zip_directory(bytes, 1'000'000)) names.push_back(entry.name);
  const auto has = [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
  EXPECT_TRUE(has("results/clearance_mm.npy"));
  EXPECT_TRUE(has("trajectories/job_0001/t_s.npy"));
  EXPECT_TRUE(has("trajectories/job_0004/slider_velocity_m_s.npy"));
  EXPECT_FALSE(has("trajectories/job_0001/journal_x_mm.npy"));
  EXPECT_FALSE(has("trajectories/job_0005/t_s.npy"));
  // Only a flexible coupler has elements.
  EXPECT_FALSE(has("trajectories/job_0001/pose_1_3_1_x_m.npy"));
  EXPECT_TRUE(has("trajectories/job_0002/pose_1_3_1_x_m.npy"));
}

TEST(GetTrajectories, HoldsEmptyColumnsOfATimeWithoutSamples) {
  Bench bench;
  const auto answer = fetch(bench, make_sweep(bench), {{"format", "npz"}, {"from", "100"}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  const std::string bytes = bytes_of(answer);
  for (const auto& entry : jobs::read_zip_directory(bytes, 1'000'000))
    EXPECT_NO_THROW(static_cast<void>(jobs::unpack(entry))) << entry.name << ": its checksum";
  EXPECT_EQ(fetch(bench, make_sweep(bench), {{"format", "h5"}, {"from", "100"}}).status, 200);
  EXPECT_EQ(fetch(bench, make_sweep(bench), {{"format", "mat"}, {"from", "100"}}).status, 200);
}

TEST(GetTrajectories, GivesTheRestOfAFile) {
  Bench bench;
  const std::string id = make_sweep(bench);
  const auto [bytes, etag] = [&] {
    const auto all = fetch(bench, id, {});
    return std::pair(bytes_of(all), header(all, "ETag"));
  }();
  const std::string size = std::to_string(bytes.size());
  const auto rest = fetch(bench, id, {}, "bytes=100-", etag);
  EXPECT_EQ(rest.status, 206);
  EXPECT_EQ(bytes_of(rest), bytes.substr(100));
  EXPECT_EQ(header(rest, "Content-Range"), "bytes 100-" + std::to_string(bytes.size() - 1) + "/" + size);
  EXPECT_EQ(bytes_of(fetch(bench, id, {}, "bytes=3-5")), bytes.substr(3, 3));
  EXPECT_EQ(bytes_of(fetch(bench, id, {}, "bytes=-7")), bytes.substr(bytes.size() - 7));
  EXPECT_EQ(bytes_of(fetch(bench, id, {}, "bytes=9-99999999")), bytes.substr(9));
  const auto beyond = fetch(bench, id, {}, "bytes=" + size + "-");
  EXPECT_EQ(beyond.status, 416);
  EXPECT_EQ(header(beyond, "Content-Range"), "bytes */" + size);
  EXPECT_EQ(fetch(bench, id, {}, "bytes=100-", "\"other\"").status, 200) << "the bytes have changed";
  server::Request head{"HEAD", "/v1/sweeps/" + id + "/trajectories", {}, "", "", "test-1"};
  head.range = "bytes=100-";
  EXPECT_EQ(bench.call(head).status, 200) << "ranges are for GET";
  for (const char* const unknown :
       {"bytes=1-2,4-5", "lines=1-2", "bytes=5-3", "bytes=a-", "bytes=-", "bytes="})
    EXPECT_EQ(fetch(bench, id, {}, unknown).status, 200) << unknown;
}

TEST(GetTrajectories, RefusesWhatThereIsNot) {
  Bench bench;
  const std::string id = make_sweep(bench);
  EXPECT_EQ(fetch(bench, "swp_01m8ex00000000000000000000", {}).status, 404);
  const auto refused = fetch(bench, id, {{"format", "xlsx"}, {"from", "x"}, {"points", "7"}});
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(json::parse(refused.body).at("errors").size(), 3U) << refused.body;
  const auto channel = fetch(bench, id, {{"channels", "slider_velocity_m_s,nothing"}});
  EXPECT_EQ(json::parse(channel.body).at("errors")[0].at("pointer"), "/channels/1") << channel.body;
  Bench endless(endless_run);
  const std::string running =
      json::parse(endless.call("POST", "/v1/sweeps", R"({"sweep": {"clearance_mm": [0.1]}})").body).at("id");
  const auto early = fetch(endless, running, {});
  EXPECT_EQ(early.status, 409);
  EXPECT_NE(early.body.find("has a trajectory"), std::string::npos) << early.body;
}

TEST(KeepMetrics, StoresNoTrajectories) {
  Bench bench;
  const std::string all = bench.run(R"({"sweep": {"clearance_mm": [0.1, 0.2]}})");
  const std::string metrics = bench.run(R"({"keep": "metrics", "sweep": {"clearance_mm": [0.1, 0.2]}})");
  const auto rows_of = [&](const std::string& id) {
    json rows = json::parse(bench.call("GET", "/v1/sweeps/" + id + "/results").body);
    for (json& row : rows) row.erase("job_id");
    return rows;
  };
  EXPECT_EQ(rows_of(metrics), rows_of(all));
  EXPECT_EQ(fetch(bench, metrics, {}).status, 409);
  const auto rows = json::parse(bench.call("GET", "/v1/sweeps/" + metrics + "/results").body);
  const std::string job = rows[0].at("job_id");
  EXPECT_EQ(bench.call("GET", "/v1/jobs/" + job + "/trajectory").status, 404);
  EXPECT_EQ(json::parse(bench.call("GET", "/v1/jobs/" + job).body).at("parameters").at("keep"), "metrics");
  // A job with its trajectory does not take the place of one without, nor the other way round.
  EXPECT_EQ(fetch(bench, bench.run(R"({"keep": "all", "sweep": {"clearance_mm": [0.1, 0.2]}})"), {}).status,
            200);
}

TEST(KeepMetrics, IsRefusedWhereTrajectoriesAreRead) {
  Bench bench;
  const auto pointer_of = [&](const std::string& path, const std::string& body) {
    const auto refused = bench.call("POST", path, body);
    EXPECT_EQ(refused.status, 422) << refused.body;
    return json::parse(refused.body).at("errors")[0].at("pointer").get<std::string>();
  };
  EXPECT_EQ(pointer_of("/v1/sweeps", R"({"keep": "nothing"})"), "/keep");
  EXPECT_EQ(pointer_of("/v1/sweeps", R"({"keep": "all", "parameters": {"keep": "metrics"}})"), "/keep");
  EXPECT_EQ(pointer_of("/v1/sweeps", R"({"sweep": {"keep": ["all", "metrics"]}})"), "/sweep/keep");
  EXPECT_EQ(pointer_of("/v1/jobs", R"({"keep": 1})"), "/keep");
  EXPECT_EQ(pointer_of("/v1/wear-studies",
                       R"({"parameters": {"keep": "metrics", "clearance_mm": 0.1}, "hours": 10,
                           "wear_coefficient_m2_n": 1e-15})"),
            "/parameters/keep");
}

TEST(GetTrajectories, LeavesNoFileBesideTheStore) {
  Bench bench;
  const std::string id = make_sweep(bench);
  const std::filesystem::path store = bench.service().store_file();
  const auto count = [&] {
    return std::ranges::count_if(
        std::filesystem::directory_iterator(store.parent_path()),
        [](const auto& entry) { return entry.path().string().find(".rpsup-export-") != std::string::npos; });
  };
  const auto sent = fetch(bench, id, {});
  EXPECT_EQ(fetch(bench, id, {{"channels", "nothing"}}).status, 422);
  EXPECT_EQ(count(), 0);
  std::ofstream(store.string() + ".rpsup-export-aBcDeF") << "of a process that died";
  const server::Routes next_process(bench.service());
  EXPECT_EQ(count(), 0);
}

}  // namespace
}  // namespace server_tests
