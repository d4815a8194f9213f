// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/path/measure.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <stdexcept>

#include "engine/analysis/run_result.h"
#include "engine/simulate_rpsup.h"
#include "jobs/parameters/job_spec.h"
#include "jobs/requests/parameters.h"

namespace path_bench {
namespace {

double clock_s(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

double process_cpu_s() { return clock_s(CLOCK_PROCESS_CPUTIME_ID); }
double thread_cpu_s() { return clock_s(CLOCK_THREAD_CPUTIME_ID); }
double wall_s() { return clock_s(CLOCK_MONOTONIC); }

double resident_mib(int pid) {
  std::ifstream status("/proc/" + (pid == 0 ? "self" : std::to_string(pid)) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024.0;
  }
  throw std::runtime_error("the memory of the process cannot be read");
}

Folder::Folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "rpsup-bench-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  folder_ = pattern;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void print_figure(const std::string& what, double figure, const std::string& unit, double at_most) {
  std::printf("%-64s %10.3f %-6s at most %8.3f  %s\n", what.c_str(), figure, unit.c_str(), at_most,
              figure <= at_most ? "kept" : "MISSED");
  std::fflush(stdout);
}

void print_ratio(const std::string& what, double figure, double at_least) {
  std::printf("%-64s %10.3f %-6s at least %7.3f  %s\n", what.c_str(), figure, "times", at_least,
              figure >= at_least ? "kept" : "MISSED");
  std::fflush(stdout);
}

void print_figure(const std::string& what, double figure, const std::string& unit) {
  std::printf("%-64s %10.3f %s\n", what.c_str(), figure, unit.c_str());
  std::fflush(stdout);
}

std::vector<Kind> job_kinds() {
  return {{"rigid, ideal joint", {{"coupler", "rigid"}, {"clearance_mm", 0}}},
          {"rigid, clearance 0.25 mm",
           {{"coupler", "rigid"}, {"clearance_mm", 0.25}, {"crank_velocity_rad_s", 10}}},
          {"flexible, ideal joint", {{"coupler", "flexible"}, {"clearance_mm", 0}}},
          {"flexible, clearance 0.25 mm",
           {{"coupler", "flexible"}, {"clearance_mm", 0.25}, {"crank_velocity_rad_s", 5}}}};
}

engine::RunResult simulate(const nlohmann::json& parameters) {
  const jobs::JobSpec spec = jobs::to_job_spec(jobs::complete_parameters(parameters, ""));
  return engine::simulate_rpsup(spec.parameters, spec.options, [](double) { return false; });
}

nlohmann::ordered_json sweep_of(std::size_t jobs, const nlohmann::json& parameters) {
  nlohmann::ordered_json common = parameters;
  common.erase("crank_velocity_rad_s");
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < jobs; ++i) values.push_back(5.0 + 1e-4 * static_cast<double>(i));
  return {{"parameters", common}, {"sweep", {{"crank_velocity_rad_s", values}}}};
}

std::size_t count_argument(int argc, char** argv, int index, std::size_t otherwise) {
  return index < argc ? std::strtoul(argv[index], nullptr, 10) : otherwise;
}

}  // namespace path_bench
