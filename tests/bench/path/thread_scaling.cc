// How many times the jobs of one thread two threads do. The ratio of passing times is only right on a quiet machine, so what it is
// made of is printed, too: how much dearer a job is beside another one, and how long threads wait for each other.
//
// usage: bench_thread_scaling [jobs] [parameters as JSON]

#include <mutex>

#include "tests/bench/path/measure.h"

namespace {

using namespace path_bench;

constexpr double kBound = 1.95;

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

}  // namespace

int main(int argc, char** argv) {
  const std::size_t jobs = count_argument(argc, argv, 1, 200);
  const auto parameters = nlohmann::json::parse(argc > 2 ? argv[2] : R"({"coupler": "rigid", "clearance_mm": 0})");
  measure(2, std::min<std::size_t>(jobs, 8), parameters);  // warms up
  const Sweep one = measure(1, jobs, parameters);
  const Sweep two = measure(2, jobs, parameters);
  const double n = static_cast<double>(jobs);
  print_figure("simulation, CPU a job, 1 thread", 1e3 * one.run_cpu_s / n, "ms");
  print_figure("simulation, CPU a job, 2 threads", 1e3 * two.run_cpu_s / n, "ms");
  print_figure("all, CPU a job, 1 thread", 1e3 * one.cpu_s / n, "ms");
  print_figure("all, CPU a job, 2 threads", 1e3 * two.cpu_s / n, "ms");
  print_figure("2 threads, share of their time outside of simulations", 100.0 * (1.0 - two.run_elapsed_s / (2.0 * two.elapsed_s)), "%");
  print_ratio("2 threads, jobs against 1, by passing time", one.elapsed_s / two.elapsed_s, kBound);
}
