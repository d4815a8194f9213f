// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"

namespace jobs {

using DesignPoints = std::vector<std::vector<nlohmann::json>>;

/// One type of design. Its functions are called with an object whose "over" has known paths only.
struct DesignKind {
  std::string_view type;
  std::string_view help;
  std::vector<std::string_view> keys;  ///< beside type and over
  /// Counts the points and adds the faults that can be seen without making them.
  std::uint64_t (*count)(const nlohmann::ordered_json& design, const nlohmann::json& parameters,
                         std::vector<Fault>& faults);
  /// Makes them, if count() has added no fault.
  DesignPoints (*make)(const nlohmann::ordered_json& design, const nlohmann::json& parameters,
                       std::vector<Fault>& faults);
};

/// All of them, in the order in which they are shown.
[[nodiscard]] std::span<const DesignKind> design_kinds();

}  // namespace jobs
