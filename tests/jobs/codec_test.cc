#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "jobs/trajectory_codec.h"

namespace jobs_tests {
namespace {

std::span<const std::byte> bytes_of(const std::string& blob) { return std::as_bytes(std::span(blob)); }

std::vector<std::uint64_t> bits_of(const std::vector<double>& column) {
  std::vector<std::uint64_t> bits;
  for (const double x : column) bits.push_back(std::bit_cast<std::uint64_t>(x));
  return bits;
}

engine::Trajectory sampled_run() {
  engine::Trajectory run;
  run.channels = {{.key = "t_s", .help = "Time"}, {.key = "slider_acceleration_m_s2", .help = "Of link (2,1)"},
                  {.key = "count", .help = "", .integer = true}, {.key = "pose_x_m", .help = "Drawn", .single_precision = true}};
  run.columns.resize(4);
  for (int k = 0; k < 1000; ++k) {
    run.columns[0].push_back(k / 1000.0);
    run.columns[1].push_back(std::sin(0.3 * k) * std::exp(0.01 * k));
    run.columns[2].push_back(k / 7);
    run.columns[3].push_back(0.1 * std::cos(0.01 * k));
  }
  run.columns[0].push_back(0.9995);  // the end of the run between two samples
  for (int i = 1; i < 4; ++i) run.columns[static_cast<std::size_t>(i)].push_back(1.0 / 3.0);
  return run;
}

TEST(TrajectoryCodec, GivesBackEveryBitThatIsKept) {
  const engine::Trajectory run = sampled_run();
  const engine::Trajectory back = jobs::decode_trajectory(bytes_of(jobs::encode_trajectory(run)), {});
  ASSERT_EQ(back.columns.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(bits_of(back.columns[i]), bits_of(run.columns[i])) << i;
  ASSERT_EQ(back.columns[3].size(), run.columns[3].size());
  for (std::size_t k = 0; k < back.columns[3].size(); ++k) {
    // Half a unit in the last of 24 bits.
    EXPECT_NEAR(back.columns[3][k], run.columns[3][k], std::abs(run.columns[3][k]) * 0x1p-24);
  }
  EXPECT_EQ(jobs::rounded_to_stored(run).columns[3], back.columns[3]);
  EXPECT_EQ(back.channels[1].key, "slider_acceleration_m_s2");
  EXPECT_EQ(back.channels[1].help, "Of link (2,1)");
  EXPECT_TRUE(back.channels[2].integer);
  EXPECT_TRUE(back.channels[3].single_precision);
  EXPECT_FALSE(back.channels[1].single_precision);
}

RC_GTEST_PROP(TrajectoryCodec, GivesBackAnyBits, (const std::vector<std::vector<std::uint64_t>>& random)) {
  engine::Trajectory run;
  const std::size_t samples = random.empty() ? 0 : random.front().size();
  for (std::size_t i = 0; i < random.size(); ++i) {
    run.channels.push_back({.key = i == 0 ? "t_s" : "c" + std::to_string(i), .help = ""});
    run.columns.emplace_back();
    for (std::size_t k = 0; k < samples; ++k) run.columns.back().push_back(std::bit_cast<double>(k < random[i].size() ? random[i][k] : 0));
  }
  const engine::Trajectory back = jobs::decode_trajectory(bytes_of(jobs::encode_trajectory(run)), {});
  RC_ASSERT(back.columns.size() == run.columns.size());
  for (std::size_t i = 0; i < run.columns.size(); ++i) RC_ASSERT(bits_of(back.columns[i]) == bits_of(run.columns[i]));
}

TEST(TrajectoryCodec, UnpacksOnlyWhatIsWanted) {
  const std::string blob = jobs::encode_trajectory(sampled_run());
  const std::vector<std::string> wanted{"count", "t_s", "no_such_channel"};
  const engine::Trajectory back = jobs::decode_trajectory(bytes_of(blob), wanted);
  ASSERT_EQ(back.channels.size(), 2U);
  EXPECT_EQ(back.channels[0].key, "count");
  EXPECT_EQ(back.columns[1], sampled_run().columns[0]);
  EXPECT_EQ(jobs::decode_channels(bytes_of(blob)).size(), 4U);
}

TEST(TrajectoryCodec, StoresAUniformTimeAxisInAFewBytes) {
  engine::Trajectory run;
  run.channels = {{.key = "t_s", .help = ""}};
  run.columns.resize(1);
  // 1/3000 is no short decimal, so no compressor makes much of this column.
  for (int k = 0; k < 100'000; ++k) run.columns[0].push_back(k / 3000.0);
  const std::string blob = jobs::encode_trajectory(run);
  EXPECT_LT(blob.size(), 200U);
  EXPECT_EQ(jobs::decode_trajectory(bytes_of(blob), {}).columns[0], run.columns[0]);
}

TEST(TrajectoryCodec, KeepsAnEmptyRun) {
  const engine::Trajectory back = jobs::decode_trajectory(bytes_of(jobs::encode_trajectory({})), {});
  EXPECT_TRUE(back.channels.empty());
}

TEST(TrajectoryCodec, RefusesColumnsOfDifferentLength) {
  engine::Trajectory run = sampled_run();
  run.columns[2].pop_back();
  EXPECT_THROW((void)jobs::encode_trajectory(run), std::invalid_argument);
  run.columns.pop_back();
  EXPECT_THROW((void)jobs::rounded_to_stored(run), std::invalid_argument);
}

// Whatever is cut off or flipped: an error or, in the two length fields outside of the checksums, at worst the same data.
TEST(TrajectoryCodec, RefusesEveryCutBlob) {
  const std::string blob = jobs::encode_trajectory(sampled_run());
  for (std::size_t size = 0; size < blob.size(); size += size < 400 ? 1 : 97) {
    EXPECT_THROW((void)jobs::decode_trajectory(bytes_of(blob.substr(0, size)), {}), jobs::DamagedTrajectory) << size;
  }
  EXPECT_THROW((void)jobs::decode_trajectory(bytes_of(blob + "x"), {}), jobs::DamagedTrajectory);
}

TEST(TrajectoryCodec, NeverTakesADamagedBlobForAnotherRun) {
  const engine::Trajectory run = sampled_run();
  const std::string blob = jobs::encode_trajectory(run);
  int refused = 0;
  int tried = 0;
  for (std::size_t i = 0; i < blob.size(); i += i < 600 ? 1 : 61) {
    for (const int bit : {0, 7}) {
      std::string damaged = blob;
      damaged[i] = static_cast<char>(static_cast<unsigned char>(damaged[i]) ^ (1U << bit));
      ++tried;
      try {
        const engine::Trajectory back = jobs::decode_trajectory(bytes_of(damaged), {});
        for (std::size_t c = 0; c < back.columns.size(); ++c) EXPECT_EQ(bits_of(back.columns[c]), bits_of(jobs::rounded_to_stored(run).columns[c])) << i;
      } catch (const jobs::DamagedTrajectory&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(tried, 1000);
  // A few bits of zstd's frame header carry no meaning.
  EXPECT_GT(refused, tried * 98 / 100);
}

}  // namespace
}  // namespace jobs_tests
