// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/npz.h"

#include <bit>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <zlib.h>

namespace jobs_tests {
namespace {

std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// Tests of the bytes alone. A test of the program reads the file by NumPy.
TEST(Npz, IsAZipArchiveOfStoredArrays) {
  engine::Trajectory trajectory;
  trajectory.channels = {{.key = "t_s", .help = ""}, {.key = "slider_position_m", .help = ""}};
  trajectory.columns = {{0.0, 0.5}, {0.1, std::nan("")}};
  const std::string bytes = jobs::to_npz(trajectory);
  ASSERT_EQ(bytes.substr(0, 4), "PK\x03\x04");
  const std::size_t data = 30 + std::strlen("t_s.npy");
  const std::uint32_t size = u32(bytes, 22);
  ASSERT_EQ(bytes.substr(data, 6), "\x93NUMPY");
  EXPECT_EQ((size - 2 * sizeof(double)) % 64, 0U);  // where the numbers begin
  double last = 0.0;
  std::memcpy(&last, bytes.data() + data + size - sizeof last, sizeof last);
  EXPECT_EQ(last, 0.5);
  EXPECT_EQ(u32(bytes, 14), crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + data), size));
  EXPECT_EQ(bytes.substr(bytes.size() - 22, 4), "PK\x05\x06");
  EXPECT_EQ(u32(bytes, u32(bytes, bytes.size() - 6)), u32(std::string("PK\x01\x02"), 0));
  EXPECT_EQ(jobs::to_npz(trajectory), bytes);
}

TEST(Npz, TakesEmptyColumns) {
  engine::Trajectory trajectory;
  trajectory.channels = {{.key = "t_s", .help = ""}};
  trajectory.columns = {{}};
  const std::string bytes = jobs::to_npz(trajectory);
  const std::size_t data = 30 + std::strlen("t_s.npy");
  EXPECT_EQ(u32(bytes, 14), crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + data), u32(bytes, 22)));
}

}  // namespace
}  // namespace jobs_tests
