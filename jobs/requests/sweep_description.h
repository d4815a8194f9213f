// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace jobs {

inline constexpr std::size_t kLongestNotes = 10'000;  ///< bytes
inline constexpr std::size_t kMostTags = 20;
inline constexpr std::size_t kLongestTag = 50;  ///< bytes

/// Notes of people on a sweep; empty: stays as it is.
struct SweepDescription {
  std::optional<std::string> name, notes;
  std::optional<std::vector<std::string>> tags;
};

/// Reads {"name", "notes", "tags"}, one of them at least.
/// @throws InvalidRequest with every fault
[[nodiscard]] SweepDescription parse_sweep_description(const nlohmann::json& request);

}  // namespace jobs
