#pragma once

#include <nlohmann/json.hpp>

#include "jobs/run_record.h"
#include "jobs/service.h"
#include "jobs/store.h"

namespace jobs {

// The resources as users see them.

enum class Detail { kFull, kListing };

/// A listing leaves out parameters and metrics.
[[nodiscard]] nlohmann::json job_json(const JobRow& row, Detail detail);

/// A listing leaves out the request. @param threads  how many jobs are computed at a time, for the ETA
[[nodiscard]] nlohmann::json sweep_json(const SweepRow& row, int threads, Detail detail);

/// A job that was computed without a store: no id, no links.
[[nodiscard]] nlohmann::json unstored_job_json(const nlohmann::json& parameters, const RunRecord& record, std::int64_t started_ms, std::int64_t ended_ms);

[[nodiscard]] ResultTable result_table(const SweepRow& sweep, const std::vector<ResultRow>& rows);

/// Seconds until the last job of a sweep ends, from what its jobs have cost so far; empty while that is not known of
/// every kind of job that is left. A running job counts as half done.
[[nodiscard]] std::optional<double> estimate_time_left_s(const SweepRow& row, int threads);

}  // namespace jobs
