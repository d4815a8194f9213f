// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "jobs/requests/expand.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/store.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {

inline constexpr std::size_t kMaxQueuedInStore = 1000;

inline jobs::SweepPlan stored_plan_of(const char* request) {
  return jobs::plan_sweep(request_of(request), 10'000);
}

inline constexpr const char* kThreeJobs = R"({"sweep": {"crank_velocity_rad_s": [5, 10, 12]}})";

inline std::string add_sweep(jobs::Store& store, const char* request) {
  return store.queue.add_sweep(stored_plan_of(request), request, kMaxQueuedInStore);
}

inline jobs::RunRecord successful_run(double metric) {
  jobs::RunRecord record;
  record.metrics = {{"peak", metric}};
  record.trajectory.channels = {{.key = "t_s", .help = ""}};
  record.trajectory.columns = {{0.0, metric}};
  record.wall_time_s = 2.0;
  return record;
}

inline jobs::RunRecord failed_run() {
  jobs::RunRecord record;
  record.end = jobs::RunRecord::End::kFailed;
  record.error_reason = "non_finite";
  record.error_detail = "no number";
  record.error_t_s = 0.5;
  return record;
}

inline std::int64_t count_of(const jobs::Store& store, const std::string& sweep, jobs::JobState state) {
  return store.reader.find_sweep(sweep).value().counts[static_cast<std::size_t>(state)];
}

}  // namespace jobs_tests
