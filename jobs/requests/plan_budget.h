// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <nlohmann/json.hpp>

namespace jobs {

/// Keeps a sweep from taking minutes to check, or gigabytes to hold: with large parameters, such as a
/// described linkage or the wear of a bore, there is room for fewer jobs than with small ones.
class PlanBudget {
 public:
  /// @param max_jobs  that a sweep with small parameters may have
  explicit PlanBudget(std::size_t max_jobs);

  /// Takes what the points of a case need.
  /// @param completed   parameters of the first of them
  /// @param replicates  jobs of each point
  /// @throws InvalidRequest if there is not so much left.
  void take(const nlohmann::json& completed, std::uint64_t points, std::uint64_t replicates);

  /// Counts what a job keeps; the points of a case may differ. @throws InvalidRequest as take() does
  void add_job(std::size_t bytes);

 private:
  /// Takes the work of closing the loops of a described linkage at each point.
  void take_closing_work(const nlohmann::json& completed, std::uint64_t points, std::uint64_t replicates);

  double work_;   ///< left of it, in checks of a linkage with few bodies
  double bytes_;  ///< left of them, for parameters
  double bytes_of_jobs_;  ///< left of them, of those of add_job()
  std::uint64_t jobs_ = 0;  ///< of add_job()
};

}  // namespace jobs
