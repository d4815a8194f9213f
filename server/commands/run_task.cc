// SPDX-License-Identifier: Apache-2.0
#include "server/commands/run_task.h"

#include <charconv>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "jobs/base/provenance.h"
#include "jobs/cluster/run_task.h"
#include "jobs/runs/run_record.h"
#include "server/commands/command.h"
#include "server/commands/signals.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

constexpr int kMostThreads = 256;

/// Number that Slurm gives a task about itself; -1 if there is none.
/// @throws BadInput if it is no such number
int number_in_environment(const char* name, int largest) {
  const char* const text = std::getenv(name);
  if (text == nullptr) return -1;
  const std::string_view digits = text;
  int number = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number < 0 || number > largest) {
    throw BadInput(std::string(name) + "=" + text + ": must be a number from 0 to " +
                   std::to_string(largest));
  }
  return number;
}

int find_task_index(const RunTaskOptions& options) {
  constexpr int kLargestIndex = 100'000'000;
  const int index =
      options.index >= 0 ? options.index : number_in_environment("SLURM_ARRAY_TASK_ID", kLargestIndex);
  if (index < 0)
    throw BadInput(
        "--index is missing, and there is no SLURM_ARRAY_TASK_ID: this is no task of an array of Slurm");
  return index;
}

int find_task_threads(const RunTaskOptions& options) {
  if (options.threads > 0) return options.threads;
  return std::max(1, number_in_environment("SLURM_CPUS_PER_TASK", kMostThreads));
}

std::string describe_program(const jobs::Provenance& program) {
  return "rpsup " + program.version + " (" + program.commit + "), engine " + program.engine + ", " +
         program.libm + ", " + program.cpu + ", " + program.host;
}

}  // namespace

int run_task(const RunTaskOptions& options) {
  const int index = find_task_index(options);
  const int threads = find_task_threads(options);
  const EndSignals signals;
  std::cerr << describe_program(jobs::own_provenance()) << '\n';
  const bool complete = jobs::cluster::run_task(
      {.folder = options.folder,
       .generation = options.generation,
       .index = index,
       .threads = threads,
       .runner = jobs::engine_runner()},
      [&] { return signals.arrived(); },
      [](const std::string& message) { std::cerr << "rpsup: " << terminal_text(message) << '\n'; });
  return complete ? kDone : kInterrupted;
}

}  // namespace server::commands
