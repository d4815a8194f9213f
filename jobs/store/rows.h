// SPDX-License-Identifier: Apache-2.0
// Rows of the store's tables as others see them, without SQLite.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/base/states.h"

namespace jobs {

struct RunRecord;

/// Number of a sweep's jobs in each state, by JobState.
using StateCounts = std::array<std::int64_t, kJobStates.size()>;

/// State of a sweep, from those of its jobs.
[[nodiscard]] std::string_view sweep_state(const StateCounts& counts);
[[nodiscard]] bool has_ended(const StateCounts& counts);

/// Cost so far of a running job.
struct RunningCost {
  double simulated_s = 1.0;  ///< as CostOfKind counts it
  double elapsed_s = 0.0;    ///< since it was claimed
  std::string id{};
  std::optional<double> part_done{};  ///< of its simulated time; empty: not known, as of the store itself
};

/// Jobs of one PlannedJob::kind in a sweep: how many are left, and what those that were computed cost. The
/// cost of a job grows with the time that it simulates, which counts as 1 s if the sweep does not vary it.
struct CostOfKind {
  std::int64_t queued = 0;
  double queued_s = 0.0;            ///< simulated time of those together
  double queued_squares_s2 = 0.0;   ///< the sum of its squares
  double longest_queued_s = 0.0;
  std::vector<RunningCost> running{};
  std::int64_t computed = 0;        ///< ended jobs that were computed, not reused
  double computed_s = 0.0;          ///< simulated time of those together
  double wall_time_s = 0.0;         ///< of those together, each on one thread
  double rates = 0.0;               ///< the sum of their wall times a simulated second
  double rate_squares = 0.0;        ///< the sum of the squares of these
};

using Costs = std::map<std::string, CostOfKind>;  ///< by PlannedJob::kind

/// Sweep that shares the threads with another one, or the jobs without a sweep.
struct RivalSweep {
  std::int64_t priority = 0;
  std::string executor{};    ///< empty: it named none
  double unit_s = 1.0;       ///< simulated time that CostOfKind counts as 1 s, [s]
  Costs costs{};
  double weight = 1.0;       ///< number of sweeps that it stands for
};

struct SweepRow {
  std::string id, name;
  std::string request;                               ///< empty in listings and changes
  std::string notes;
  std::string tags = "[]";                           ///< JSON list of texts
  std::string swept;
  bool replicated = false;
  std::int64_t priority = 0;
  std::string executor;                              ///< empty: it named none
  std::optional<std::string> study_id;               ///< study that its jobs evaluate
  std::int64_t created_ms = 0;
  /// Start of its first job, and end of its last one if all have ended
  std::optional<std::int64_t> started_ms, ended_ms;
  StateCounts counts{};
  // The rest only of sweeps that have not ended:
  Costs costs;
  double unit_s = 1.0;                               ///< as RivalSweep's
  /// Others that have not ended, or a sample; the rows of a listing share them
  std::vector<std::shared_ptr<const RivalSweep>> rivals;
  /// Wall time a simulated second by kind, of the store's last results; empty if nothing needs it
  std::map<std::string, double> cost_rates;
};

/// The run behind a result.
struct RunRow {
  double wall_time_s = 0.0, cpu_time_s = 0.0;
  std::string host, cpu, version, commit, compiler, engine;
  std::string libm, numerics;  ///< empty: of a time when they were not noted
};

struct JobRow {
  std::string id;
  std::optional<std::string> sweep_id;
  std::optional<std::int64_t> replicate;
  std::string state;
  std::string parameters;              ///< empty in listings
  std::optional<std::string> metrics;  ///< empty in listings
  std::optional<std::string> error_reason;
  std::string error_detail;
  std::optional<double> error_t_s;
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> started_ms, ended_ms;
  std::int64_t attempts = 0;
  bool reused = false;
  std::optional<RunRow> run;
};

/// Study, whose evaluations are the jobs of a sweep.
struct StudyRow {
  std::string id, sweep_id, name, request, state;
  std::optional<std::string> error;  ///< fault that stopped the study
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> ended_ms;
};

/// Measurement without its samples.
struct MeasurementRow {
  std::string id, name;
  std::string description;      ///< as measurement_json() makes it
  std::int64_t created_ms = 0;
  std::int64_t bytes = 0;       ///< of the packed samples
};

enum class RowParameters { kNone, kAll };

/// One job's line in the table of its sweep.
struct ResultRow {
  std::string job_id, state, swept;
  std::optional<std::int64_t> replicate;
  std::optional<std::string> metrics;
  std::string parameters{};  ///< RowParameters::kAll only
  std::int64_t change = 0;   ///< EndedJob::change; 0: it has not ended
  std::optional<std::string> error_reason{}, error_detail{};  ///< of what failed
};

/// All jobs of a sweep in one snapshot of the store.
struct SweepResults {
  SweepRow sweep;
  /// Rows in the order in which the sweep was expanded, later additions last
  std::vector<ResultRow> rows;
};

/// Study with its jobs, in one snapshot of the store.
struct StudySnapshot {
  StudyRow study;
  SweepResults results;
};

/// A job that has ended.
struct EndedJob {
  std::int64_t change = 0;  ///< grows from end to end; what ended in one transaction shares it
  std::string id, state;
  std::optional<std::string> error_reason;
  std::int64_t ended_ms = 0;
  bool reused = false;
};

/// Changes of a sweep since a change.
struct SweepChanges {
  SweepRow sweep;
  std::vector<EndedJob> ended;  ///< by change
};

/// Job that a worker has claimed.
struct ClaimedJob {
  std::int64_t seq = 0;
  std::string id;
  std::int64_t attempt = 0;  ///< a record must name it: what an earlier attempt left is void
  std::string parameters;
};

/// Called with a job while it is being claimed.
using OnClaim = std::function<void(const ClaimedJob&)>;

/// Jobs that are given to a cluster together.
struct BatchRow {
  std::int64_t seq = 0;
  std::string id, sweep_id;  ///< the latter empty: of single jobs
};

/// A job of a batch.
struct BatchJob {
  std::uint32_t batch_index = 0;
  std::string parameters, kind;
  double duration_s = 0.0;   ///< simulated
};

/// Result of a job of a batch.
struct BatchRecord {
  std::uint32_t batch_index = 0;
  const RunRecord* record = nullptr;           ///< its trajectory is not looked at
  const std::string* packed_trajectory = nullptr;  ///< by encode_trajectory; empty: none
};

}  // namespace jobs
