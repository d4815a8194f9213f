// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "jobs/base/provenance.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/store_connection.h"

namespace jobs {

/// @param metrics  JSON text
/// @returns its number
std::int64_t insert_result(Statements& statements, std::int64_t content, const RunRecord& record,
                           const std::string& metrics, const Provenance& provenance);

/// @param blob  by encode_trajectory
void insert_trajectory(Statements& statements, std::int64_t result, const std::string& blob);

/// Completes queued jobs of the same content with a new result.
void complete_duplicates(Statements& statements, std::int64_t content, std::int64_t result,
                         std::int64_t now_ms, std::int64_t change);

}  // namespace jobs
