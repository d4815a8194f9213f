#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/search/limit.h"
#include "jobs/search/search_request.h"
#include "jobs/service.h"
#include "jobs/store.h"

namespace jobs {

/// What a search has found for one combination of its axes.
struct CombinationPicture {
  std::vector<nlohmann::json> values;  ///< one an axis
  std::vector<Evaluation> evaluations;
  std::vector<std::vector<std::string>> job_ids;  ///< of each evaluation
  bool cancelled = false;              ///< whether any of its jobs was
  Limit limit;
};

/// How far a search is, as its jobs say: a search keeps nothing else, and so goes on after a crash where it was.
struct SearchPicture {
  std::vector<CombinationPicture> combinations;

  [[nodiscard]] bool has_ended() const;
  [[nodiscard]] std::string end_state() const;  ///< once it has ended
};

[[nodiscard]] SearchPicture make_picture(const SearchRequest& search, const SweepResults& results);

/// The resource as users see it. @param threads  how many jobs are computed at a time
[[nodiscard]] nlohmann::json search_json(const SearchRow& row, const SearchRequest& search, const SweepResults& results, int threads);

/// A listing has no limits, and does not look at the jobs.
[[nodiscard]] nlohmann::json search_summary_json(const SearchRow& row);
[[nodiscard]] const std::vector<std::string>& search_listing_keys();

/// Flat rows, one a combination: the axes, what was looked for, the limit and its band.
[[nodiscard]] ResultTable limit_table(const SearchRow& row, const SearchRequest& search, const SweepResults& results);

}  // namespace jobs
