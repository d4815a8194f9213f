// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/optimisation/optimisation_request.h"
#include "jobs/optimisation/point_search.h"
#include "jobs/store/rows.h"
#include "jobs/studies/study_runner.h"

namespace jobs {

/// Values of the variables, and the metrics of their jobs.
struct OptimisationCandidate {
  std::vector<double> values;  ///< one a variable
  std::size_t pending = 0;     ///< jobs that have not ended
  std::vector<std::string> job_ids{};
  /// Over the jobs, for each objective and then for each bound
  std::vector<std::vector<double>> metrics{};
  /// Reason for a job without value: its error_reason, "cancelled", "no_value", or kInvalidParameters
  std::optional<std::string> lost_reason{};
};

/// Value of an objective (its index) or a bound (number of objectives + its index) of a candidate that has
/// all its values.
[[nodiscard]] double objective_of(const OptimisationRequest& request, const OptimisationCandidate& candidate,
                                  std::size_t objective);
[[nodiscard]] double bound_value_of(const OptimisationRequest& request,
                                    const OptimisationCandidate& candidate, std::size_t bound);

/// State of a candidate as users see it.
enum class CandidateState { kPending, kFeasible, kInfeasible, kLost };
[[nodiscard]] std::string_view state_name(CandidateState state);
[[nodiscard]] CandidateState state_of(const OptimisationRequest& request,
                                      const OptimisationCandidate& candidate);

/// End of the search from one start.
enum class StartEnd { kRunning, kConverged, kBudget };
[[nodiscard]] std::string_view end_name(StartEnd end);

/// Search from one start.
struct StartSearch {
  std::unique_ptr<PointSearch> search;
  std::set<std::vector<double>> seen{};         ///< candidates that it has asked for
  std::vector<std::vector<double>> in_order{};  ///< the same, in the order of asking
  StartEnd end = StartEnd::kRunning;
};

/// Candidate, by its index, and the first of the starts that asked for it.
struct ListedCandidate {
  std::size_t index = 0;
  std::optional<std::size_t> start{};  ///< empty: none did, as of a job added to the sweep by hand
};

/// Sampler of an optimisation. All of it follows from the request and the results of the jobs, so that a
/// study goes on after a crash and no candidate is computed twice.
class Optimiser final : public StudySampler {
 public:
  /// @param results  null: no job has been made yet
  Optimiser(OptimisationRequest request, const nlohmann::ordered_json& common_sweep,
            const SweepResults* results);

  void tell(const ResultRow& ended) override;
  [[nodiscard]] NextCases ask() override;
  [[nodiscard]] double progress() const override;

  [[nodiscard]] const OptimisationRequest& request() const { return request_; }
  [[nodiscard]] const std::vector<OptimisationCandidate>& candidates() const { return candidates_; }
  [[nodiscard]] const std::vector<StartSearch>& starts() const { return starts_; }
  /// All candidates whose jobs are made, start by start: in an order that does not depend on the order in
  /// which jobs ended.
  [[nodiscard]] std::vector<ListedCandidate> list_candidates() const;
  /// Feasible candidates that no other one is better than in every objective: one or more if any is feasible.
  [[nodiscard]] std::vector<ListedCandidate> find_front() const;
  /// Faults of the first candidate whose parameters do not fit together.
  [[nodiscard]] const std::optional<InvalidRequest>& first_invalid() const { return first_invalid_; }

 private:
  /// Index of the candidate with these values, which is added if there is none.
  std::size_t index_of(const std::vector<double>& values);
  OptimisationCandidate& candidate_of(const ResultRow& job);
  void take_result(const ResultRow& job, OptimisationCandidate& candidate);
  [[nodiscard]] std::optional<std::vector<double>> find_fitness(const std::vector<double>& values) const;
  /// Cases of the next candidates of one start.
  void ask_start(StartSearch& start, NextCases& next);
  /// Points that a search asks for; none if it has ended.
  [[nodiscard]] std::vector<UnitPoint> ask_search(StartSearch& start) const;
  /// Adds a candidate and its case, unless there is one. @returns whether it has jobs that have not ended
  bool add_candidate(const std::vector<double>& values, NextCases& next);
  /// Number of jobs of a case; 0 if its parameters do not fit together.
  [[nodiscard]] std::size_t count_jobs(const nlohmann::ordered_json& one_case);
  void end_study(NextCases& next) const;

  const OptimisationRequest request_;
  const nlohmann::ordered_json common_sweep_;
  std::vector<std::size_t> positions_;             ///< of each variable in ResultRow::swept
  std::vector<OptimisationCandidate> candidates_;  ///< in the order in which they were asked for
  std::size_t made_ = 0;  ///< candidates with jobs; those that follow were dropped after a cancellation
  std::map<std::vector<double>, std::size_t> indices_;
  std::vector<StartSearch> starts_;
  bool cancelled_ = false;  ///< whether a job was
  std::optional<InvalidRequest> first_invalid_;
};

}  // namespace jobs
