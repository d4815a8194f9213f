// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/rpsup_jobs.h"

#include <stdexcept>

#include "validation/support/runs.h"
#include "tests/bench/support/contact_state.h"
#include "tests/bench/support/cpu_time.h"

namespace bench {

CodeRun run_rpsup(const engine::RpsupParameters& parameters, const engine::RunOptions& options) {
  const engine::RunResult run = engine::simulate_rpsup(parameters, options, {});
  if (run.status != engine::RunStatus::kSucceeded) throw std::runtime_error("a run failed: " + run.detail);
  return {validation::metric(run, "peak_slider_acceleration_m_s2"),
          static_cast<long>(validation::metric(run, "rhs_evaluations"))};
}

double time_rpsup_evaluation(const engine::RpsupParameters& parameters) {
  ContactState state(parameters);
  return time_short([&state] { state.evaluate(); });
}

}  // namespace bench
