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
#include "jobs/store/store.h"

namespace jobs {

/// What a search has found for one combination of its axes.
struct CombinationPicture {
  std::vector<nlohmann::json> values;  ///< one an axis
  std::vector<Evaluation> evaluations;
  std::vector<std::vector<std::string>> job_ids;  ///< of each evaluation, as far as they were told
  std::size_t pending = 0;             ///< jobs that have not ended
  bool cancelled = false;              ///< whether any of its jobs was
  Limit limit;
};

/// How far a search is, as its jobs say: a search keeps nothing else, and so goes on after a crash where it was.
struct SearchPicture {
  std::vector<CombinationPicture> combinations;

  [[nodiscard]] std::string end_state() const;  ///< once it has ended
};

/// Part of the evaluations that a search may need which it has, 0 .. 1.
[[nodiscard]] double calc_progress(const SearchPicture& picture, const SearchRequest& search);

/// The lost_reason of an evaluation whose job succeeded, and has no value of the metric. Others are a job's error_reason, or the state in which it ended: "cancelled".
inline constexpr std::string_view kNoValue = "no_value";

/// Sorts the jobs of a search into its combinations, each once when it is added and once when it ends.
class SearchTally {
 public:
  /// @param sweep   of the jobs
  /// @param search  must outlive the tally
  SearchTally(const SearchRequest& search, const SweepRow& sweep);

  /// Takes a job. @returns its combination; empty if it is none of the search's, and was added to the sweep by hand
  std::optional<std::size_t> add(const ResultRow& job);
  /// Takes what became of a job that had not ended before. Returns as add() does.
  std::optional<std::size_t> end(const ResultRow& job);
  /// Takes the jobs of an evaluation that will be added.
  void expect(std::size_t combination, double x);

  SearchPicture picture;  ///< limits are the caller's

 private:
  /// A job's place in the search.
  struct Place {
    std::size_t combination = 0;
    std::size_t evaluation = 0;
  };

  [[nodiscard]] std::optional<Place> find_place(const ResultRow& job);
  void take_result(const ResultRow& job, const Place& place);

  const SearchRequest& search_;
  std::size_t parameter_ = 0;        ///< where values stand among what is swept
  std::vector<std::size_t> axes_;
  std::map<std::string, std::size_t> combinations_;  ///< by the identity of their values
};

}  // namespace jobs
