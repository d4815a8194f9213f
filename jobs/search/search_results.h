// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/search/limit.h"
#include "jobs/search/search_request.h"
#include "jobs/store/rows.h"

namespace jobs {

/// Results of a search for one combination of its axes.
struct CombinationResults {
  std::vector<nlohmann::json> values;  ///< one an axis
  std::vector<Evaluation> evaluations;
  std::vector<std::vector<std::string>>
      job_ids;                         ///< of each evaluation; without those of jobs that were only expected
  std::size_t pending = 0;             ///< jobs that have not ended
  Limit limit;                         ///< set by SearchResults::judge()
};

/// Value of lost_reason for an evaluation whose job succeeded without a value of the metric. Otherwise
/// lost_reason is the job's error_reason, or "cancelled".
inline constexpr std::string_view kNoValue = "no_value";
/// The same for values of parameters that do not fit together, so that no job computes them.
inline constexpr std::string_view kInvalidParameters = "invalid_parameters";

/// Results of a search by combination and evaluation. Each job is taken twice at most: when it is added, and
/// when it ends.
class SearchResults {
 public:
  /// @param search  must outlive the results
  /// @param sweep   of the jobs
  SearchResults(const SearchRequest& search, const SweepRow& sweep);

  /// Takes a job. @returns its combination; empty if the search has none such, as of a job added to the sweep
  /// by hand
  std::optional<std::size_t> add(const ResultRow& job);
  /// Takes the end of a job that was pending. Returns as add() does.
  std::optional<std::size_t> end(const ResultRow& job);
  /// Finds the limit of a combination. Values to evaluate next that do not fit together are lost.
  /// @param common_sweep  sweep of the search without cases
  /// @returns number of jobs of each value in Limit::next; empty after a cancellation
  std::vector<std::size_t> judge(std::size_t combination, const nlohmann::ordered_json& common_sweep);
  /// Counts jobs of an evaluation as pending before they are added.
  void expect(std::size_t combination, double x, std::size_t jobs);

  [[nodiscard]] bool any_pending() const;
  [[nodiscard]] std::string end_state() const;  ///< once no combination is open, or after a cancellation
  /// Evaluations that have ended over those that may be needed, 0 .. 1.
  [[nodiscard]] double calc_progress() const;

  std::vector<CombinationResults> combinations;
  bool cancelled = false;  ///< whether any job was

 private:
  /// Indices of a job's combination and evaluation.
  struct Position {
    std::size_t combination = 0;
    std::size_t evaluation = 0;
  };

  [[nodiscard]] std::optional<Position> find_position(const ResultRow& job);
  void add_result(const ResultRow& job, const Position& position);
  /// Number of jobs at x; 0: its parameters do not fit together.
  [[nodiscard]] std::size_t count_jobs(const CombinationResults& combination, double x,
                                       const nlohmann::ordered_json& common_sweep) const;

  const SearchRequest& search_;
  std::size_t parameter_ = 0;        ///< index of the searched parameter in ResultRow::swept
  std::vector<std::size_t> axes_;    ///< the same of each axis
  std::map<std::string, std::size_t> combination_indices_;  ///< by the identity of their values
};

}  // namespace jobs
