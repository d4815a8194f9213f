// SPDX-License-Identifier: Apache-2.0
// Whether memory stays flat: this process' memory after sweeps of more and more jobs without a simulation,
// and what a large sweep takes while it is submitted and while its results are read.
//
// usage: bench_sweep_memory [jobs of the small sweep] [jobs of the large sweep]

#include <malloc.h>

#include "engine/analysis/quantities.h"
#include "engine/analysis/run_result.h"
#include "jobs/parameters/job_spec.h"
#include "jobs/service.h"
#include "tests/bench/path/made_store.h"
#include "tests/bench/path/measure.h"

namespace {

using namespace path_bench;

constexpr double kBound_mib = 8.0;  // caches of SQLite, of the allocator

double memory_after(std::size_t jobs, std::size_t samples) {
  const Folder folder;
  jobs::ServiceOptions options;
  options.store = folder.file("study.db");
  options.runner = [&](const jobs::JobSpec& spec, const engine::StopQuery&) {
    engine::RunResult result;
    for (std::size_t i = 0; i < engine::metric_table().size(); ++i)
      result.metrics.push_back(spec.parameters.crank_velocity);
    result.trajectory.channels = {{.key = "t_s", .help = "time"}, {.key = "slider_position_m", .help = ""}};
    result.trajectory.columns.assign(2, std::vector<double>(samples, spec.parameters.crank_velocity));
    return result;
  };
  jobs::Service service(options);
  service.wait_for_sweep(service.submit_sweep(sweep_of(jobs, nlohmann::json::object())).at("id"),
                         std::chrono::hours(1));
  malloc_trim(0);  // what is free does not count
  return resident_mib();
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t few = count_argument(argc, argv, 1, 1000);
  const std::size_t many = count_argument(argc, argv, 2, 5000);
  memory_after(few, 1000);  // warms up
  const double after_few = memory_after(few, 1000);
  const double after_many = memory_after(many, 1000);
  print_figure("after " + std::to_string(few) + " jobs", after_few, "MiB");
  print_figure("after " + std::to_string(many) + " jobs", after_many, "MiB");
  print_figure("growth from the one to the other", after_many - after_few, "MiB", kBound_mib);
}
