// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>

namespace jobs {

struct JobSpec;

/// Limits of one job. A job that reaches a limit fails, with the limit's name as its reason. Zero: no limit.
struct JobLimits {
  double wall_time_s = 0.0;       ///< "time_limit"
  long steps = 0;                 ///< of the integrator, "step_limit"; the engine has one of its own, too
  std::size_t memory_bytes = 0;   ///< that its trajectory takes while it runs, "memory_limit"
};

/// A job that would take more memory than it may.
class NeedsTooMuchMemory : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Input of the engine for a job, within the limits.
/// @throws NeedsTooMuchMemory before any of it is taken
[[nodiscard]] JobSpec within_limits(JobSpec spec, const JobLimits& limits);

}  // namespace jobs
