// SPDX-License-Identifier: Apache-2.0
// Trajectories by blocks: the numbers and the bytes of those that are read at once.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/results/csv.h"
#include "jobs/results/table_json.h"
#include "jobs/results/trajectory_table_text.h"
#include "jobs/trajectories/npz.h"
#include "jobs/trajectories/trajectory_query.h"
#include "jobs/trajectories/trajectory_text.h"

namespace jobs_tests {
namespace {

/// More samples than a block of any kind has, one of every encoding, and a channel that is another's copy.
engine::Trajectory long_run(std::size_t samples) {
  engine::Trajectory run;
  run.channels = {{.key = "t_s", .help = ""}, {.key = "a", .help = "", .single_precision = true},
                  {.key = "b", .help = ""}, {.key = "copy", .help = "", .single_precision = true},
                  {.key = "count", .help = "", .integer = true}};
  run.columns.resize(run.channels.size());
  for (std::size_t k = 0; k < samples; ++k) {
    const auto t = static_cast<double>(k);
    run.columns[0].push_back(t / 1000.0);
    run.columns[1].push_back(k % 97 == 0 ? 1e6 * std::sin(t) : std::sin(0.01 * t));
    run.columns[2].push_back(k % 1013 == 0 ? std::numeric_limits<double>::quiet_NaN() : std::cos(0.3 * t));
    run.columns[4].push_back(std::floor(t / 7));
  }
  run.columns[3] = run.columns[1];
  return run;
}

jobs::StoredBytes stored(const std::string& blob) {
  return {.size = blob.size(),
          .read_to = [&blob](std::size_t offset, std::span<char> to) {
            ASSERT_LE(offset + to.size(), blob.size());
            std::ranges::copy(std::string_view(blob).substr(offset, to.size()), to.begin());
          }};
}

std::string all_of(std::unique_ptr<jobs::TrajectoryText> text) {
  std::string all;
  while (text->append_next(all)) {
  }
  return all;
}

TEST(TrajectoryView, GivesTheBytesOfATrajectoryThatIsReadAtOnce) {
  for (const std::size_t samples : {0U, 1U, 2U, 15U, 16U, 17U, 4096U, 8192U, 16'384U, 20'011U}) {
    const std::string blob = jobs::encode_trajectory(long_run(samples));
    const std::vector<jobs::TrajectoryQuery> queries{
        {},
        {.channels = {"b", "a", "b"}, .from = {}, .to = {}},
        {.channels = {"t_s"}, .from = 0.5, .to = {}},
        {.channels = {}, .from = 0.016, .to = 9.9995},
        {.channels = {}, .from = {}, .to = -1.0},
        {.channels = {}, .from = 1e9, .to = {}},
        {.channels = {"a"}, .from = 0.1, .to = 15.0, .points = 101},
        {.channels = {"t_s"}, .from = {}, .to = {}, .points = 50},
        {.channels = {}, .from = {}, .to = {}, .points = 500}};
    for (std::size_t q = 0; q < queries.size(); ++q) {
      const engine::Trajectory expected =
          jobs::read_trajectory(std::as_bytes(std::span(blob)), queries[q]);
      const auto view = [&] {
        jobs::TrajectoryView made(stored(blob), queries[q]);
        made.load(stored(blob));
        return made;
      };
      const engine::Trajectory whole = view().read_all();
      ASSERT_EQ(whole.columns.size(), expected.columns.size());
      for (std::size_t c = 0; c < whole.columns.size(); ++c) {
        ASSERT_EQ(whole.columns[c].size(), expected.columns[c].size()) << samples << " samples, query " << q;
        EXPECT_TRUE(whole.columns[c].empty() ||
                    std::memcmp(whole.columns[c].data(), expected.columns[c].data(),
                                whole.columns[c].size() * sizeof(double)) == 0)
            << samples << " samples, query " << q << ", channel " << c;
      }
      EXPECT_TRUE(all_of(jobs::csv_text(view())) == jobs::to_csv(expected)) << samples << " samples, query " << q;
      EXPECT_TRUE(all_of(jobs::json_text(view())) == jobs::to_json_columns(expected)) << samples << " samples, query " << q;
      EXPECT_TRUE(all_of(jobs::npz_text(view())) == jobs::to_npz(expected)) << samples << " samples, query " << q;
    }
  }
}

TEST(TrajectoryView, IsNamedByItsNumbersAndItsQuery) {
  const std::string blob = jobs::encode_trajectory(long_run(1000));
  engine::Trajectory other = long_run(1000);
  other.columns[2][500] += 1e-9;
  const std::string changed = jobs::encode_trajectory(other);
  const auto name_of = [](const std::string& bytes, const jobs::TrajectoryQuery& query) {
    return jobs::TrajectoryView(stored(bytes), query).fingerprint();
  };
  const jobs::TrajectoryQuery part{.channels = {"a"}, .from = 0.1, .to = {}};
  EXPECT_EQ(name_of(blob, {}), name_of(blob, {}));
  EXPECT_NE(name_of(blob, {}), name_of(changed, {}));
  EXPECT_NE(name_of(blob, {}), name_of(blob, part));
  EXPECT_NE(name_of(blob, {.channels = {"a"}, .from = 0.1, .to = {}}), name_of(blob, {.channels = {"a"}, .from = {}, .to = 0.1}));
}

TEST(TrajectoryView, RefusesAFaultyQueryAndDamage) {
  const std::string blob = jobs::encode_trajectory(long_run(1000));
  EXPECT_THROW(jobs::TrajectoryView(stored(blob), {.channels = {"none"}, .from = {}, .to = {}}), jobs::InvalidRequest);
  const std::string whole = jobs::to_npz(jobs::decode_trajectory(std::as_bytes(std::span(blob)), {}));
  std::size_t refused = 0;
  for (std::size_t place = 0; place < blob.size(); place += 7) {
    std::string damaged = blob;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x10);
    try {
      jobs::TrajectoryView view(stored(damaged), {});
      view.load(stored(damaged));
      // Some bits of a frame mean nothing.
      EXPECT_TRUE(jobs::to_npz(view.read_all()) == whole) << place;
    } catch (const jobs::DamagedTrajectory&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, blob.size() / 7 - 10);
}

}  // namespace
}  // namespace jobs_tests
