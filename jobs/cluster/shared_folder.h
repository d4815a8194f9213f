// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "jobs/cluster/site.h"

namespace jobs::cluster {

/// Copies the program that nodes run into the shared folder, under a name made of what it holds: a new build
/// never changes what runs.
/// @returns where it is
/// @throws FileError
[[nodiscard]] std::filesystem::path share_program(const Site& site);

/// Script that Slurm runs for each task of a generation.
[[nodiscard]] std::string make_script(const Site& site, const std::filesystem::path& program,
                                      const std::string& arguments);

/// The last lines of a file, at most so many bytes; empty if it cannot be read.
[[nodiscard]] std::string tail_of(const std::filesystem::path& file, std::size_t most_bytes);

}  // namespace jobs::cluster
