// SPDX-License-Identifier: Apache-2.0
// Runs the same job again and again, for a profiler.
//   bench_profile CASE [JOBS]   CASE: one of --list, or a file with a job's parameters
//   bench_profile --list

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "jobs/run_job.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/table.h"

namespace bench {
namespace {

using nlohmann::json;

/// Parameters of each case that differ from the default (0.25 mm, 10 rad/s).
const std::map<std::string_view, json>& cases() {
  static const std::map<std::string_view, json> all{
      {"rigid", {{"duration_s", 4}}},
      {"flexible", {{"duration_s", 4}, {"coupler", "flexible"}}},
      {"elements", {{"duration_s", 4}, {"contact", "elements"}}},
      {"flexible_16", {{"duration_s", 1}, {"coupler", "flexible"}, {"rigid_elements", 16}}},
      {"flexible_64", {{"duration_s", 0.2}, {"coupler", "flexible"}, {"rigid_elements", 64}}},
      {"ideal", {{"duration_s", 4}, {"clearance_mm", 0}}},
  };
  return all;
}

json read_case(const std::string& name) {
  if (const auto found = cases().find(name); found != cases().end()) return found->second;
  std::ifstream file(name);
  if (!file) throw std::runtime_error(name + " is no case, and no file that can be read");
  return json::parse(file);
}

/// Prints the processor time of the fastest job, [ms].
void run(const json& parameters, int count) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i) {
    json job;
    const auto never = [](double) { return false; };
    least = std::min(least, time_cpu([&] { job = jobs::run_job(parameters, never).job; }));
    if (job.at("state") != "succeeded") throw std::runtime_error("the job failed: " + job.at("error").dump());
  }
  std::cout << digits(1e3 * least, 3) << '\n';
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  try {
    if (argc == 2 && std::string_view(argv[1]) == "--list") {
      for (const auto& [name, parameters] : bench::cases()) std::cout << name << '\n';
      return EXIT_SUCCESS;
    }
    const int count = argc > 2 ? std::atoi(argv[2]) : 1;
    if (argc < 2 || argc > 3 || count < 1) {
      std::cerr << "usage: bench_profile CASE [JOBS] | --list\n";
      return 2;
    }
    bench::run(bench::read_case(argv[1]), count);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::cerr << "bench_profile: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
