// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/rows.h"

namespace jobs {

// The resources as users see them.

enum class Detail { kFull, kListing };

/// A listing leaves out parameters and metrics. @param wanted  keys; others need not be made. Empty: all
[[nodiscard]] nlohmann::json job_json(const JobRow& row, Detail detail,
                                      const std::vector<std::string>& wanted = {});

/// A listing leaves out the request. @param threads  how many jobs are computed at a time, for the ETA
/// @param default_executor  of sweeps that name none
[[nodiscard]] nlohmann::json sweep_json(const SweepRow& row, int threads, Detail detail,
                                        std::string_view default_executor = {});

/// A job that was computed without a store: no id, no links.
[[nodiscard]] nlohmann::json unstored_job_json(const nlohmann::json& parameters, const RunRecord& record,
                                               std::int64_t started_ms, std::int64_t ended_ms);

/// Fields that the resources of all studies have. @param route  "/v1/searches/", say; the id follows it
[[nodiscard]] nlohmann::json study_json(const StudyRow& row, const std::string& route);

/// Progress of a sweep, a part of its resource.
[[nodiscard]] nlohmann::json progress_json(const SweepRow& row, int threads,
                                           std::string_view default_executor = {});

/// Keys of an object.
[[nodiscard]] std::vector<std::string> keys_of(const nlohmann::json& object);

/// The keys that items of a listing may have.
[[nodiscard]] const std::vector<std::string>& sweep_listing_keys();
[[nodiscard]] const std::vector<std::string>& job_listing_keys();

/// JSON that any reader takes, whatever bytes a name has.
[[nodiscard]] std::string text_of(const nlohmann::json& value);

/// A text of the store as JSON. @throws StorageError if it is none
[[nodiscard]] nlohmann::json stored_json(const std::string& text);

/// The parameters that a sweep varies.
[[nodiscard]] std::vector<std::string> swept_of(const SweepRow& sweep);

/// @param others  columns at the end: parameters that the sweep does not vary, and kErrorColumns; rows carry
///     their parameters if needed_parameters(others)
/// @param replicate_metric  that replicates are compared by; empty: see choose_free_metric()
/// @throws InvalidRequest as choose_metric() does
[[nodiscard]] ResultTable result_table(const SweepResults& results, const std::vector<std::string>& others,
                                       const std::string& replicate_metric = {});

}  // namespace jobs
