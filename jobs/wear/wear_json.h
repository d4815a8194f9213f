// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"
#include "jobs/store/rows.h"
#include "jobs/wear/wear_integrator.h"
#include "jobs/wear/wear_request.h"

namespace jobs {

/// Part of the study that is done, 0 .. 1.
[[nodiscard]] double calc_progress(const WearStudyRequest& study, const WearHistory& history);

/// Resource as users see it. @param threads  how many jobs are computed at a time
[[nodiscard]] nlohmann::json wear_study_json(const StudyRow& row, const WearStudyRequest& study,
                                             const SweepResults& results, const WearHistory& history,
                                             int threads);

/// Entry of a listing: has no cycles, and is made without a look at the jobs.
[[nodiscard]] nlohmann::json wear_summary_json(const StudyRow& row);
[[nodiscard]] const std::vector<std::string>& wear_listing_keys();

/// Columns of a cycle, before the metrics of its job.
inline constexpr std::array<std::string_view, 11> kWearColumns{"cycle",
                                                               "job_id",
                                                               "hours",
                                                               "step_hours",
                                                               "deepest_um",
                                                               "deepest_position_mm",
                                                               "deepest_angle_rad",
                                                               "clearance_mm",
                                                               "rate_um_h",
                                                               "rate_change",
                                                               "worn_volume_mm3"};

/// Rows of the cycles: kWearColumns and every metric.
[[nodiscard]] ResultTable wear_table(const StudyRow& row, const WearStudyRequest& study,
                                     const SweepResults& results, const WearHistory& history);

}  // namespace jobs
