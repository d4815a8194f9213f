// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "jobs/trajectories/trajectory_codec.h"

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
  run.channels = {{.key = "t_s", .help = "Time"},
                  {.key = "slider_acceleration_m_s2", .help = "Of link (2,1)"},
                  {.key = "count", .help = "", .integer = true},
                  {.key = "pose_x_m", .help = "Drawn", .single_precision = true}};
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

TEST(TrajectoryCodec, GivesBackThousandsOfChannels) {
  engine::Trajectory run;
  for (int i = 0; i < 10'000; ++i) {
    run.channels.push_back({.key = "c" + std::to_string(i), .help = std::string(200, 'h')});
    run.columns.push_back({0.5 * i, 1.5 * i});
  }
  const engine::Trajectory back = jobs::decode_trajectory(bytes_of(jobs::encode_trajectory(run)), {});
  ASSERT_EQ(back.channels.size(), run.channels.size());
  EXPECT_EQ(back.channels.back().key, "c9999");
  EXPECT_EQ(back.columns.back(), run.columns.back());
}

RC_GTEST_PROP(TrajectoryCodec, GivesBackAnyBits, (const std::vector<std::vector<std::uint64_t>>& random)) {
  engine::Trajectory run;
  const std::size_t samples = random.empty() ? 0 : random.front().size();
  for (std::size_t i = 0; i < random.size(); ++i) {
    run.channels.push_back({.key = i == 0 ? "t_s" : "c" + std::to_string(i), .help = ""});
    run.columns.emplace_back();
    for (std::size_t k = 0; k < samples; ++k)
      run.columns.back().push_back(std::bit_cast<double>(k < random[i].size() ? random[i][k] : 0));
  }
  const engine::Trajectory back = jobs::decode_trajectory(bytes_of(jobs::encode_trajectory(run)), {});
  RC_ASSERT(back.columns.size() == run.columns.size());
  for (std::size_t i = 0; i < run.columns.size(); ++i)
    RC_ASSERT(bits_of(back.columns[i]) == bits_of(run.columns[i]));
}

/// A channel of single precision. @param samples  as bits of floats
void expect_singles_back(const std::vector<std::uint32_t>& samples) {
  engine::Trajectory run;
  run.channels = {{.key = "t_s", .help = "", .single_precision = true}};
  run.columns.resize(1);
  for (const std::uint32_t bits : samples)
    run.columns[0].push_back(static_cast<double>(std::bit_cast<float>(bits)));
  const engine::Trajectory back = jobs::decode_trajectory(bytes_of(jobs::encode_trajectory(run)), {});
  RC_ASSERT(bits_of(back.columns.at(0)) == bits_of(jobs::rounded_to_stored(run).columns[0]));
}

RC_GTEST_PROP(TrajectoryCodec, GivesBackAnySingles, (const std::vector<std::uint32_t>& samples)) {
  expect_singles_back(samples);
  // Blocks of every width, and every number of samples in the last one.
  std::vector<std::uint32_t> narrow;
  for (std::size_t k = 0; k < samples.size(); ++k)
    narrow.push_back(0x3f800000U + (samples[k] * 0x9e3779b9U >> (k / 16 % 33 < 32 ? k / 16 % 33 : 0)));
  expect_singles_back(narrow);
}

TEST(TrajectoryCodec, GivesBackSmoothSinglesOfEveryOrder) {
  for (int power = 0; power <= 6; ++power) {
    for (const int samples : {1, 2, 15, 16, 17, 1000}) {
      engine::Trajectory run;
      run.channels = {{.key = "t_s", .help = ""}, {.key = "x", .help = "", .single_precision = true}};
      run.columns.resize(2);
      for (int k = 0; k < samples; ++k) {
        run.columns[0].push_back(k / 1000.0);
        run.columns[1].push_back(std::pow(1e-2 * k - 2.0, power));  // through zero, with a change of sign
      }
      const engine::Trajectory back = jobs::decode_trajectory(bytes_of(jobs::encode_trajectory(run)), {});
      EXPECT_EQ(bits_of(back.columns[1]), bits_of(jobs::rounded_to_stored(run).columns[1]))
          << power << ' ' << samples;
    }
  }
}

TEST(TrajectoryCodec, GivesBackSinglesThatNeverChange) {
  for (const double value : {0.0, -0.0, 1.0 / 3.0, -2e-300, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
    for (const std::size_t samples : {1U, 2U, 16U, 17U, 5001U}) {
      engine::Trajectory run;
      run.channels = {{.key = "x", .help = "", .single_precision = true}};
      run.columns = {std::vector<double>(samples, value)};
      const std::string blob = jobs::encode_trajectory(run);
      EXPECT_EQ(bits_of(jobs::decode_trajectory(bytes_of(blob), {}).columns[0]),
                bits_of(jobs::rounded_to_stored(run).columns[0]))
          << value << ' ' << samples;
      EXPECT_LT(blob.size(), 200U) << value << ' ' << samples;
    }
  }
}

TEST(TrajectoryCodec, StoresASmoothColumnInLessThanTwoBytesASample) {
  engine::Trajectory run;
  run.channels = {{.key = "t_s", .help = ""}, {.key = "x", .help = "", .single_precision = true}};
  run.columns.resize(2);
  for (int k = 0; k < 5000; ++k) {
    run.columns[0].push_back(k / 1000.0);
    run.columns[1].push_back(std::sin(10.0 * k / 1000.0));
  }
  EXPECT_LT(jobs::encode_trajectory(run).size(), 5000U * 2U);
}

TEST(TrajectoryCodec, StoresAColumnThatIsAnotherOnesOnlyOnce) {
  const auto of = [](int copies) {
    engine::Trajectory run;
    for (int i = 0; i < copies; ++i) {
      run.channels.push_back({.key = "c" + std::to_string(i), .help = "", .single_precision = i % 2 == 0});
      run.columns.emplace_back();
      for (int k = 0; k < 1000; ++k) run.columns.back().push_back(std::sin(0.37 * k * k));
    }
    return run;
  };
  const std::string two = jobs::encode_trajectory(of(2));
  const std::string four = jobs::encode_trajectory(of(4));
  EXPECT_LT(four.size(), two.size() + 100U);
  const std::vector<std::string> wanted{"c3", "c2"};
  const engine::Trajectory back = jobs::decode_trajectory(bytes_of(four), wanted);
  EXPECT_EQ(back.channels[0].key, "c3");
  EXPECT_EQ(back.columns[0], of(4).columns[3]);
  EXPECT_EQ(back.columns[1], jobs::rounded_to_stored(of(4)).columns[2]);
}

TEST(TrajectoryCodec, StoresWhatRepeatsTheTimeOnlyOnce) {
  engine::Trajectory run = sampled_run();
  const std::size_t alone = jobs::encode_trajectory(run).size();
  run.channels.push_back({.key = "clock_s", .help = ""});
  run.columns.push_back(run.columns[0]);
  const std::string blob = jobs::encode_trajectory(run);
  EXPECT_LT(blob.size(), alone + 50U);
  EXPECT_EQ(bits_of(jobs::decode_trajectory(bytes_of(blob), {}).columns[4]), bits_of(run.columns[0]));
}

TEST(TrajectoryCodec, StoresWhatIsTheSameWhenRoundedOnlyOnce) {
  engine::Trajectory run;
  run.columns.resize(3);
  for (int k = 0; k < 1000; ++k) {
    const double x = static_cast<double>(static_cast<float>(std::sin(0.37 * k * k)));
    run.columns[0].push_back(x);
    // the third is a copy of a copy
    for (std::size_t i = 1; i < 3; ++i) run.columns[i].push_back(x * (1.0 + 1e-12));
  }
  for (const char* key : {"a", "b", "c"})
    run.channels.push_back({.key = key, .help = "", .single_precision = true});
  const std::string blob = jobs::encode_trajectory(run);
  EXPECT_EQ(jobs::decode_trajectory(bytes_of(blob), {}).columns, jobs::rounded_to_stored(run).columns);
  run.channels.resize(1);
  run.columns.resize(1);
  EXPECT_LT(blob.size(), jobs::encode_trajectory(run).size() + 100U);
}

// A blob in a store of the first version of the program.
TEST(TrajectoryCodec, ReadsBlobsOfVersionOne) {
  const std::string hex =
      "014f00000028b52ffd244d15020022c40d1590471d8076896ca55a1f657777a7e4f908b2cdca143f50ca4bd6d1464c7557b008"
      "db69dd3f683f5f84c3e857ef0c223f88909b"
      "ff6c0202004253c00160014c3f505128b52ffd24108100000000000000408f40fca9f1d24d62603fad47fa3f28b52ffd24186d"
      "0000380000f008003f40010033c002e8e3fb"
      "2f28b52ffd2418850000509a555599b9d5e53f3f3f0100ca8e0846a64d2728b52ffd240c610000cdababccaaaaccaa2a3d3e3f"
      "9f4a290c";
  std::string blob;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    blob += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  const engine::Trajectory back = jobs::decode_trajectory(bytes_of(blob), {});
  ASSERT_EQ(back.channels.size(), 4U);
  EXPECT_EQ(back.channels[3].key, "b");
  EXPECT_TRUE(back.channels[3].single_precision);
  EXPECT_EQ(back.columns[0], (std::vector<double>{0.0, 0.001, 0.002}));
  EXPECT_EQ(back.columns[1], (std::vector<double>{0.0, 1.0, 3.0}));
  EXPECT_EQ(back.columns[2], (std::vector<double>{0.1, 1.0 / 3.0, 2.0 / 3.0}));
  EXPECT_EQ(back.columns[3], (std::vector<double>{0.1F, 1.0F / 3.0F, 2.0F / 3.0F}));
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

// Whatever is cut off or flipped: an error or, in the two length fields outside of the checksums, at worst
// the same data.
TEST(TrajectoryCodec, RefusesEveryCutBlob) {
  const std::string blob = jobs::encode_trajectory(sampled_run());
  for (std::size_t size = 0; size < blob.size(); size += size < 400 ? 1 : 97) {
    EXPECT_THROW((void)jobs::decode_trajectory(bytes_of(blob.substr(0, size)), {}), jobs::DamagedTrajectory)
        << size;
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
        for (std::size_t c = 0; c < back.columns.size(); ++c)
          EXPECT_EQ(bits_of(back.columns[c]), bits_of(jobs::rounded_to_stored(run).columns[c])) << i;
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
