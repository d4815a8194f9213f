// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace path_bench {

/// Fills a store, through the service, with sweeps whose results are made up: every metric a number with all
/// its digits, and a trajectory of a few samples. Returns the id of the last sweep.
std::string make_store(const std::filesystem::path& file, std::size_t sweeps, std::size_t jobs_each);

}  // namespace path_bench
