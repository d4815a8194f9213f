// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/slurm.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace jobs::cluster {
namespace {

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// "123" of "123" or "123;cluster", the first line of what sbatch --parsable prints.
std::optional<std::string> read_array_job(const std::string& text) {
  const std::string line = first_line(text);
  const std::string number = line.substr(0, line.find(';'));
  const bool digits =
      !number.empty() && std::ranges::all_of(number, [](unsigned char c) { return std::isdigit(c) != 0; });
  return digits ? std::optional(number) : std::nullopt;
}

/// The value of a line "Key    = value" of scontrol show config.
std::string find_setting(const std::string& config, const std::string& key) {
  std::istringstream lines(config);
  for (std::string line; std::getline(lines, line);) {
    const auto equals = line.find('=');
    if (equals == std::string::npos || line.substr(0, line.find_first_of(" \t=")) != key) continue;
    const auto start = line.find_first_not_of(" \t", equals + 1);
    return start == std::string::npos ? "" : line.substr(start);
  }
  return "";
}

int leading_number(const std::string& text) { return std::atoi(text.c_str()); }

std::string whole_minutes(double seconds) {
  return std::to_string(std::max(1L, std::lround(std::ceil(seconds / 60.0))));
}

/// ssh gives its words to a shell on the other side.
bool is_remote_shell(const std::vector<std::string>& prefix) {
  return !prefix.empty() && std::filesystem::path(prefix.front()).filename() == "ssh";
}

}  // namespace

ProcessOutcome Slurm::run(std::vector<std::string> command, std::chrono::milliseconds deadline) const {
  std::vector<std::string> arguments = site_.prefix;
  for (std::string& word : command)
    arguments.push_back(is_remote_shell(site_.prefix) ? shell_quoted(word) : std::move(word));
  return run_process(arguments, deadline, stop_);
}

/// No signal is asked for before the time limit: a task that ended because of it would count as failed. At
/// the limit Slurm sends one anyway, and what is ready is left in the folder within moments.
std::vector<std::string> Slurm::submit_arguments(const ArrayOrder& order) const {
  std::string array = "--array=0-" + std::to_string(order.tasks - 1);
  if (order.tasks > site_.slots) array += "%" + std::to_string(site_.slots);
  std::vector<std::string> arguments{"sbatch",
                                     "--parsable",
                                     "--job-name=" + order.name,
                                     array,
                                     "--nodes=1",
                                     "--ntasks=1",
                                     "--cpus-per-task=" + std::to_string(site_.threads),
                                     "--time=" + whole_minutes(order.time_s),
                                     "--requeue",
                                     "--open-mode=append",
                                     "--chdir=" + order.folder.string(),
                                     "--output=" + order.log};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) arguments.push_back(option + value);
  };
  add("--partition=", site_.partition);
  add("--account=", site_.account);
  add("--qos=", site_.qos);
  add("--constraint=", site_.constraint);
  if (site_.memory_mb > 0) add("--mem-per-cpu=", std::to_string(site_.memory_mb * order.memory_factor));
  arguments.insert(arguments.end(), site_.options.begin(), site_.options.end());
  arguments.push_back(order.script.string());
  return arguments;
}

Submission Slurm::submit(const ArrayOrder& order) const {
  const ProcessOutcome outcome = run(submit_arguments(order), site_.submit_deadline);
  if (!outcome.succeeded()) return {.array_job = std::nullopt, .problem = "sbatch: " + outcome.text()};
  auto number = read_array_job(outcome.out);
  if (!number)
    return {.array_job = std::nullopt,
            .problem = "sbatch answered what is no number: " + first_line(outcome.out).substr(0, 200)};
  return {.array_job = std::move(number), .problem = {}};
}

std::optional<Reports> Slurm::observe(const std::vector<std::string>& names, std::string& problem) const {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
  const ProcessOutcome outcome = run({"squeue", "--noheader", "--array", "--states=all", "--name=" + list,
                                      "--format=" + std::string(kReportFormat)},
                                     site_.query_deadline);
  if (!outcome.succeeded()) {
    problem = "squeue: " + outcome.text();
    return std::nullopt;
  }
  auto reports = parse_reports(outcome.out);
  if (!reports) problem = "squeue answered what cannot be read: " + first_line(outcome.out).substr(0, 200);
  return reports;
}

void Slurm::cancel_array(const std::string& name) const {
  (void)run({"scancel", "--name=" + name}, site_.query_deadline);
}

void Slurm::cancel_tasks(const std::string& array_job, const std::vector<int>& indices) const {
  std::string list;
  for (const int index : indices) list += (list.empty() ? "" : ",") + std::to_string(index);
  (void)run({"scancel", array_job + "_[" + list + "]"}, site_.query_deadline);
}

std::optional<SlurmLimits> Slurm::find_limits(std::string& problem) const {
  const ProcessOutcome outcome = run({"scontrol", "show", "config"}, site_.query_deadline);
  SlurmLimits limits{.version = find_setting(outcome.out, "SLURM_VERSION"),
                     .max_array_size = leading_number(find_setting(outcome.out, "MaxArraySize"))};
  if (outcome.succeeded() && limits.max_array_size > 0) return limits;
  problem = "scontrol show config: " + (outcome.succeeded() ? "it names no MaxArraySize" : outcome.text());
  return std::nullopt;
}

}  // namespace jobs::cluster
