// SPDX-License-Identifier: Apache-2.0
// Ratio of the jobs of two threads to those of one thread, by turns in some rounds, whose median counts.
// The ratio of passing times is only right on a quiet machine, so its parts are printed, too: the extra cost
// of a job beside another one, the time that threads wait for each other, and the ratio for threads that do
// nothing but simulate, without queue or store.
//
// usage: bench_thread_scaling [jobs] [parameters as JSON]

#include <algorithm>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/analysis/run_result.h"
#include "engine/simulate_rpsup.h"
#include "jobs/parameters/job_spec.h"
#include "jobs/service.h"
#include "tests/bench/path/measure.h"

namespace {

using namespace path_bench;

constexpr double kBound = 1.95;
constexpr int kRounds = 7;

struct Sweep {
  double elapsed_s = 0.0;
  double cpu_s = 0.0;              ///< of the process
  double run_cpu_s = 0.0;          ///< inside of the runner
  double run_elapsed_s = 0.0;      ///< inside of the runner, all threads together
};

Sweep measure(int threads, std::size_t jobs, const nlohmann::json& parameters) {
  const Folder folder;
  Sweep sweep;
  std::mutex mutex;
  jobs::ServiceOptions options;
  options.store = folder.file("study.db");
  options.threads = threads;
  options.runner = [&](const jobs::JobSpec& spec, const engine::StopQuery& stop) {
    const double cpu = thread_cpu_s();
    const double elapsed = wall_s();
    engine::RunResult result = engine::simulate_rpsup(spec.parameters, spec.options, stop);
    const std::lock_guard lock(mutex);
    sweep.run_cpu_s += thread_cpu_s() - cpu;
    sweep.run_elapsed_s += wall_s() - elapsed;
    return result;
  };
  jobs::Service service(options);
  const auto request = sweep_of(jobs, parameters);
  const double cpu = process_cpu_s();
  const double elapsed = wall_s();
  service.wait_for_sweep(service.submit_sweep(request).at("id"), std::chrono::hours(1));
  sweep.elapsed_s = wall_s() - elapsed;
  sweep.cpu_s = process_cpu_s() - cpu;
  return sweep;
}

/// Time that as many simulations, of the sweep's first job, take in bare threads. @param jobs  even
double measure_bare(int threads, std::size_t jobs, nlohmann::json parameters) {
  parameters["crank_velocity_rad_s"] = 5.0;
  const double elapsed = wall_s();
  {
    std::vector<std::jthread> running;
    for (int i = 0; i < threads; ++i)
      running.emplace_back([&] {
        for (std::size_t k = 0; k < jobs / static_cast<std::size_t>(threads); ++k) (void)simulate(parameters);
      });
  }
  return wall_s() - elapsed;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + kRounds / 2);
  return values[kRounds / 2];
}

double median(const std::vector<Sweep>& sweeps, double Sweep::*part) {
  std::vector<double> values;
  for (const Sweep& sweep : sweeps) values.push_back(sweep.*part);
  return median(values);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t jobs = 2 * ((count_argument(argc, argv, 1, 500) + 1) / 2);
  const auto parameters =
      nlohmann::json::parse(argc > 2 ? argv[2] : R"({"coupler": "rigid", "clearance_mm": 0})");
  measure(2, std::min<std::size_t>(jobs, 8), parameters);  // warms up
  std::vector<Sweep> one, two;
  // of a round, so that a machine that changes its pace matters to few
  std::vector<double> ratios, bare_ratios;
  for (int round = 0; round < kRounds; ++round) {
    one.push_back(measure(1, jobs, parameters));
    two.push_back(measure(2, jobs, parameters));
    ratios.push_back(one.back().elapsed_s / two.back().elapsed_s);
    const double one_bare = measure_bare(1, jobs, parameters);
    bare_ratios.push_back(one_bare / measure_bare(2, jobs, parameters));
  }
  const double n = static_cast<double>(jobs);
  print_figure("simulation, CPU a job, 1 thread", 1e3 * median(one, &Sweep::run_cpu_s) / n, "ms");
  print_figure("simulation, CPU a job, 2 threads", 1e3 * median(two, &Sweep::run_cpu_s) / n, "ms");
  print_figure("all, CPU a job, 1 thread", 1e3 * median(one, &Sweep::cpu_s) / n, "ms");
  print_figure("all, CPU a job, 2 threads", 1e3 * median(two, &Sweep::cpu_s) / n, "ms");
  const double in_simulations = median(two, &Sweep::run_elapsed_s) / (2.0 * median(two, &Sweep::elapsed_s));
  print_figure("2 threads, share of their time outside of simulations", 100.0 * (1.0 - in_simulations), "%");
  print_figure("2 threads, bare simulations against 1, by passing time", median(bare_ratios), "times");
  print_ratio("2 threads, jobs against 1, by passing time", median(ratios), kBound);
}
