// SPDX-License-Identifier: Apache-2.0
#include "server/commands/memory_limit.h"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace server_tests {
namespace {

using server::commands::choose_job_memory;
using server::commands::find_memory_limit;

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

TEST(MemoryLimit, IsTheLeastOfTheGroupsAround) {
  const std::filesystem::path root = std::filesystem::path(testing::TempDir()) / "memory_limit_v2";
  write(root / "proc/self/cgroup", "0::/system.slice/rpsup.service\n");
  EXPECT_EQ(find_memory_limit(root), std::nullopt);
  write(root / "sys/fs/cgroup/system.slice/rpsup.service/memory.max", "max\n");
  EXPECT_EQ(find_memory_limit(root), std::nullopt);
  write(root / "sys/fs/cgroup/system.slice/memory.max", "2000000000\n");
  EXPECT_EQ(find_memory_limit(root), 2'000'000'000);
  write(root / "sys/fs/cgroup/system.slice/rpsup.service/memory.max", "512000000\n");
  EXPECT_EQ(find_memory_limit(root), 512'000'000);
  std::filesystem::remove_all(root);
}

TEST(MemoryLimit, IsReadOfTheFirstVersionOfTheInterface) {
  const std::filesystem::path root = std::filesystem::path(testing::TempDir()) / "memory_limit_v1";
  write(root / "proc/self/cgroup", "7:cpu,cpuacct:/other\n3:memory:/box\n0::/\n");
  write(root / "sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(find_memory_limit(root), std::nullopt);
  write(root / "sys/fs/cgroup/memory/box/memory.limit_in_bytes", "700000000\n");
  EXPECT_EQ(find_memory_limit(root), 700'000'000);
  std::filesystem::remove_all(root);
}

TEST(MemoryLimit, LeavesRoomForAJobOnEachThreadBesideClients) {
  EXPECT_EQ(choose_job_memory(std::nullopt, 2), 1'024'000'000);
  EXPECT_EQ(choose_job_memory(100'000'000'000, 2), 1'024'000'000);
  for (const int threads : {1, 2, 8}) {
    const std::size_t each = choose_job_memory(4'000'000'000, threads);
    EXPECT_LE(static_cast<std::size_t>(threads) * each / 8 * 9 + 350'000'000, 4'000'000'000) << threads;
    EXPECT_GE(each, 16'000'000) << threads;
  }
  EXPECT_EQ(choose_job_memory(100'000'000, 2), 16'000'000);
}

}  // namespace
}  // namespace server_tests
