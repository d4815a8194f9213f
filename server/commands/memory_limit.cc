// SPDX-License-Identifier: Apache-2.0
#include "server/commands/memory_limit.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

namespace server::commands {

namespace {

/// Least number in the files of this name in a folder and the folders around it, up to `top`.
void take_limits(const std::filesystem::path& top, std::string_view group, const char* file,
                 std::optional<std::size_t>& least) {
  std::filesystem::path folder = top / std::filesystem::path(group).relative_path();
  for (;;) {
    std::size_t bytes = 0;
    if (std::ifstream(folder / file) >> bytes) least = std::min(least.value_or(bytes), bytes);
    if (folder == top || folder == folder.root_path() || folder.empty()) return;
    folder = folder.parent_path();
  }
}

}  // namespace

/// Lines of /proc/self/cgroup: "0::PATH" of version 2; "NUMBER:CONTROLLERS:PATH" of version 1 (cgroups(7)).
/// Version 2 writes "max" where there is no limit, version 1 a number beyond every memory.
std::optional<std::size_t> find_memory_limit(const std::filesystem::path& root) {
  constexpr std::size_t kNone = std::size_t{1} << 60;
  std::optional<std::size_t> least;
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string group = line.substr(second + 1);
    if (controllers == ",,") take_limits(root / "sys/fs/cgroup", group, "memory.max", least);
    if (controllers.find(",memory,") != std::string::npos)
      take_limits(root / "sys/fs/cgroup/memory", group, "memory.limit_in_bytes", least);
  }
  return least && *least < kNone ? least : std::nullopt;
}

std::size_t choose_job_memory(std::optional<std::size_t> limit, int threads) {
  constexpr std::size_t kDefault = 1'024'000'000, kLeast = 16'000'000;
  constexpr std::size_t kClients = 350'000'000;
  if (!limit) return kDefault;
  const std::size_t for_jobs = *limit > kClients ? *limit - kClients : 0;
  // A job takes up to an eighth more than its trajectory.
  return std::clamp(for_jobs / 9 * 8 / static_cast<std::size_t>(threads), kLeast, kDefault);
}

}  // namespace server::commands
