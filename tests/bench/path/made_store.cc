// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/path/made_store.h"

#include <cmath>

#include "engine/analysis/quantities.h"
#include "engine/analysis/run_result.h"
#include "jobs/parameters/job_spec.h"
#include "jobs/service.h"
#include "tests/bench/path/measure.h"

namespace path_bench {
namespace {

engine::RunResult made_result(const jobs::JobSpec& spec) {
  const double x = spec.parameters.crank_velocity;
  engine::RunResult result;
  result.t_end = spec.options.duration;
  for (std::size_t i = 0; i < engine::metric_table().size(); ++i)
    result.metrics.push_back(std::sqrt(x + static_cast<double>(i)) * 1e3);
  result.trajectory.channels = {{.key = "t_s", .help = "time"},
                                {.key = "slider_position_m", .help = "z of link (2,1)"}};
  result.trajectory.columns = {{0.0, 0.1, 0.2}, {x, std::sqrt(x), 1.0 / x}};
  return result;
}

}  // namespace

std::string make_store(const std::filesystem::path& file, std::size_t sweeps, std::size_t jobs_each) {
  jobs::ServiceOptions options;
  options.store = file;
  options.max_sweep_jobs = jobs_each;
  options.runner = [](const jobs::JobSpec& spec, const engine::StopQuery&) { return made_result(spec); };
  jobs::Service service(options);
  std::string id;
  for (std::size_t i = 0; i < sweeps; ++i) {
    id = service.submit_sweep(sweep_of(jobs_each, {{"clearance_mm", 0.1 + 0.01 * static_cast<double>(i)}}))
             .at("id");
    service.wait_for_sweep(id, std::chrono::hours(1));
  }
  return id;
}

}  // namespace path_bench
