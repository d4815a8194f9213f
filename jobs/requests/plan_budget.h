// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <nlohmann/json.hpp>

namespace jobs {

/// Keeps a sweep over described linkages from taking minutes to check, or gigabytes to hold: a large linkage
/// has room for fewer jobs than a small one.
class PlanBudget {
 public:
  /// @param max_jobs  that a sweep of small linkages may have
  explicit PlanBudget(std::size_t max_jobs);

  /// Takes what the points of a case need.
  /// @param completed   parameters of the first of them
  /// @param replicates  jobs of each point
  /// @throws InvalidRequest if there is not so much left.
  void take(const nlohmann::json& completed, std::uint64_t points, std::uint64_t replicates);

 private:
  double work_;   ///< left of it, in checks of a linkage with few bodies
  double bytes_;  ///< left of them, for parameters
};

}  // namespace jobs
