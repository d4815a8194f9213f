// SPDX-License-Identifier: Apache-2.0
#include "jobs/runs/job_limits.h"

#include <algorithm>
#include <cmath>

#include "jobs/base/size_text.h"
#include "jobs/parameters/job_spec.h"
#include "jobs/requests/parameters.h"

namespace jobs {

JobSpec within_limits(JobSpec spec, const JobLimits& limits) {
  if (limits.steps > 0) spec.options.step_limit = std::min(spec.options.step_limit, limits.steps);
  if (limits.memory_bytes == 0) return spec;
  // Samples are kept in double precision until the job has ended.
  const double channel_bytes =
      sizeof(double) * (std::floor(spec.options.duration * spec.options.output_rate) + 1.0);
  if (has_more_channels(spec, static_cast<double>(limits.memory_bytes) / channel_bytes)) {
    const double needed = channel_bytes * static_cast<double>(channel_table(spec).size());
    throw NeedsTooMuchMemory(
        "the trajectory takes " + size_text(needed) + " while the job runs; this service allows " +
        size_text(static_cast<double>(limits.memory_bytes)) + ": lower output_rate_hz or duration_s");
  }
  return spec;
}

}  // namespace jobs
