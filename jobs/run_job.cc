// SPDX-License-Identifier: Apache-2.0
#include "jobs/run_job.h"

#include <cstdint>
#include <utility>

#include "jobs/base/time_text.h"
#include "jobs/requests/parameters.h"
#include "jobs/results/resource_json.h"
#include "jobs/runs/run_record.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {

using nlohmann::json;

Outcome run_job(const json& parameters, const engine::StopQuery& stop_requested) {
  const json completed = complete_parameters(parameters, "");
  const std::int64_t started_ms = now_unix_ms();
  RunRecord record = run_and_record(to_job_spec(completed), engine_runner(), stop_requested);
  return {.job = unstored_job_json(completed, record, started_ms, now_unix_ms()),
          .trajectory = rounded_to_stored(std::move(record.trajectory))};
}

}  // namespace jobs
