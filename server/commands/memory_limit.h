// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

namespace server::commands {

/// Least memory limit of the control groups of this process, as systemd's MemoryMax and containers set it, of
/// either version of the interface, [byte]; empty: none.
/// @param root  "/", or a folder that has proc/self/cgroup and sys/fs/cgroup of its own
[[nodiscard]] std::optional<std::size_t> find_memory_limit(const std::filesystem::path& root);

/// Memory for the trajectory of a job so that as many jobs as there are threads fit into a limit, beside the
/// clients, [byte]; at most the default of a service without limit.
[[nodiscard]] std::size_t choose_job_memory(std::optional<std::size_t> limit, int threads);

}  // namespace server::commands
