// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/analysis/run_result.h"

namespace path_bench {

/// CPU time of all threads of this process, [s].
[[nodiscard]] double process_cpu_s();
/// CPU time of the calling thread, [s].
[[nodiscard]] double thread_cpu_s();
/// Time that passes, [s] from some start.
[[nodiscard]] double wall_s();

/// Memory that a process has in RAM, [MiB]. @param pid  0: this one
[[nodiscard]] double resident_mib(int pid = 0);

/// A folder of its own, gone with this.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }

 private:
  std::filesystem::path folder_;
};

/// Prints one line: what, its figure with its unit, the bound that it should keep, and whether it does.
void print_figure(const std::string& what, double figure, const std::string& unit, double at_most);
void print_ratio(const std::string& what, double figure, double at_least);
/// Prints a figure that no bound belongs to.
void print_figure(const std::string& what, double figure, const std::string& unit);

/// One job of each kind whose trajectories differ most: rigid or flexible coupler, ideal joint or clearance.
struct Kind {
  std::string name;
  nlohmann::json parameters;
};
[[nodiscard]] std::vector<Kind> job_kinds();

/// Computes a job.
[[nodiscard]] engine::RunResult simulate(const nlohmann::json& parameters);

/// A sweep of that many jobs over the crank's velocity. @param parameters  what they have in common
[[nodiscard]] nlohmann::ordered_json sweep_of(std::size_t jobs, const nlohmann::json& parameters);

/// argv[index] as a number; `otherwise` if it is not given.
[[nodiscard]] std::size_t count_argument(int argc, char** argv, int index, std::size_t otherwise);

}  // namespace path_bench
