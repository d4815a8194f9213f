// SPDX-License-Identifier: Apache-2.0
// Cost of a job beside its simulation: planning and queueing the job, claiming it, reading its parameters,
// encoding and storing its results. One thread; CPU time of the whole process less that of the runner, so
// that other programs do not matter.
//
// usage: bench_job_overhead [jobs without simulation] [jobs with a trajectory]

#include <condition_variable>
#include <mutex>

#include "engine/analysis/run_result.h"
#include "engine/simulate_rpsup.h"
#include "jobs/parameters/job_spec.h"
#include "jobs/runs/run_record.h"
#include "jobs/service.h"
#include "tests/bench/path/measure.h"

namespace {

using namespace path_bench;

constexpr double kBound_ms = 0.5;

/// Counts runs and what they cost; holds them until all jobs are queued.
class Meter {
 public:
  jobs::Runner around(jobs::Runner run) {
    return [this, run = std::move(run)](const jobs::JobSpec& spec, const engine::StopQuery& stop) {
      await_start();
      const double cpu = thread_cpu_s();
      const double wall = wall_s();
      engine::RunResult result = run(spec, stop);
      const std::lock_guard lock(mutex_);
      cpu_s += thread_cpu_s() - cpu;
      wall_time_s += wall_s() - wall;
      return result;
    };
  }

  void start() {
    const std::lock_guard lock(mutex_);
    started_ = true;
    changed_.notify_all();
  }

  double cpu_s = 0.0, wall_time_s = 0.0;  // read after the last run

 private:
  void await_start() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return started_; });
  }

  std::mutex mutex_;  // guards the rest and the sums
  std::condition_variable changed_;
  bool started_ = false;
};

void measure(const std::string& what, std::size_t jobs, const nlohmann::json& parameters,
             const jobs::Runner& runner) {
  const Folder folder;
  Meter meter;
  jobs::ServiceOptions options;
  options.store = folder.file("study.db");
  options.threads = 1;
  options.runner = meter.around(runner);
  jobs::Service service(options);
  const auto request = sweep_of(jobs, parameters);
  const double n = static_cast<double>(jobs);

  const double queue_cpu = process_cpu_s();
  const std::string id = service.submit_sweep(request).at("id");
  const double queue_ms = 1e3 * (process_cpu_s() - queue_cpu) / n;

  const double cpu = process_cpu_s();
  const double wall = wall_s();
  meter.start();
  service.wait_for_sweep(id, std::chrono::hours(1));
  const double run_ms = 1e3 * (process_cpu_s() - cpu - meter.cpu_s) / n;
  const double wall_ms = 1e3 * (wall_s() - wall - meter.wall_time_s) / n;

  print_figure(what + ": queue, CPU a job", queue_ms, "ms");
  print_figure(what + ": claim, encode, store, CPU a job", run_ms, "ms");
  print_figure(what + ": claim, encode, store, passing time a job", wall_ms, "ms");
  print_figure(what + ": queue, claim, encode, store, CPU a job", queue_ms + run_ms, "ms", kBound_ms);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t short_jobs = count_argument(argc, argv, 1, 2000);
  const std::size_t long_jobs = count_argument(argc, argv, 2, 200);

  const nlohmann::json tiny{
      {"coupler", "rigid"}, {"clearance_mm", 0}, {"duration_s", 0.01}, {"output_rate_hz", 100}};
  measure("0.01 s job", short_jobs, tiny, [](const jobs::JobSpec& spec, const engine::StopQuery& stop) {
    return engine::simulate_rpsup(spec.parameters, spec.options, stop);
  });

  // The simulation is done once and its result handed out again: it is the rest that is measured.
  for (const Kind& kind : job_kinds()) {
    const engine::RunResult result = simulate(kind.parameters);
    const auto& columns = result.trajectory.columns;
    const std::string size = std::to_string(columns.front().size()) + " x " + std::to_string(columns.size());
    measure(kind.name + ", " + size, long_jobs, kind.parameters,
            [&](const jobs::JobSpec&, const engine::StopQuery&) { return result; });
  }
}
