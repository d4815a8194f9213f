// SPDX-License-Identifier: Apache-2.0
#include "server/commands/cluster_options.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "jobs/cluster/process.h"
#include "server/commands/command.h"

namespace server::commands {

namespace {

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
}

}  // namespace

void add_cluster_options(CLI::App& command, ClusterOptions& options) {
  const auto add_text = [&](const char* name, std::string& value, const char* help, const char* variable,
                            const char* type) {
    command.add_option(name, value, help)->type_name(type)->envname(variable);
  };
  const auto add_number = [&](const char* name, auto& value, double least, double largest, const char* help,
                              const char* variable) {
    command.add_option(name, value, help)
        ->check(CLI::Range(least, largest))
        ->capture_default_str()
        ->envname(variable);
  };
  add_text("--slurm-folder", options.folder,
           "Shared folder, which this machine and all nodes of the Slurm cluster see under the same name; "
           "without one: no cluster",
           "RPSUP_SLURM_FOLDER", "FOLDER");
  add_text("--slurm-partition", options.partition, "Partition, as sbatch takes it", "RPSUP_SLURM_PARTITION",
           "NAME");
  add_text("--slurm-account", options.account, "Account, as sbatch takes it", "RPSUP_SLURM_ACCOUNT", "NAME");
  add_text("--slurm-qos", options.qos, "Quality of service, as sbatch takes it", "RPSUP_SLURM_QOS", "NAME");
  add_text("--slurm-constraint", options.constraint,
           "Features of nodes, as sbatch takes them; processors of one kind give results that are equal to "
           "the bit",
           "RPSUP_SLURM_CONSTRAINT", "TEXT");
  command
      .add_option("--slurm-option", options.options,
                  "Additional option of sbatch, one word, as --slurm-option=--exclude=n7; may be repeated")
      ->type_name("OPTION")
      ->envname("RPSUP_SLURM_OPTION");
  add_text("--slurm-prologue", options.prologue,
           "Command that each task runs first in a login shell of bash, as 'module load gcc'",
           "RPSUP_SLURM_PROLOGUE", "TEXT");
  add_text("--slurm-prefix", options.prefix, "Prefix of each Slurm command, as 'ssh login --'",
           "RPSUP_SLURM_PREFIX", "TEXT");
  add_text("--slurm-program", options.program, "Program that nodes run, if not this one",
           "RPSUP_SLURM_PROGRAM", "FILE");
  add_number("--slurm-threads", options.threads, 1, 256,
             "Processors of a task, and jobs that it computes at a time", "RPSUP_SLURM_THREADS");
  add_number("--slurm-slots", options.slots, 1, 1e6, "Maximum number of running tasks", "RPSUP_SLURM_SLOTS");
  add_number("--slurm-tasks", options.tasks, 0, 1e6,
             "Maximum number of waiting and running tasks, as the site allows; 0: twice the slots",
             "RPSUP_SLURM_TASKS");
  add_number("--slurm-memory-mb", options.memory_mb, 0, 1e9,
             "Memory per processor of a task, in MB; 0: the site's default", "RPSUP_SLURM_MEMORY_MB");
  add_number("--slurm-task-s", options.task_s, 0.001, 1e6, "Target task duration, in s",
             "RPSUP_SLURM_TASK_S");
  add_number("--slurm-least-task-s", options.least_task_s, 0.001, 1e6, "Minimum task duration, in s",
             "RPSUP_SLURM_LEAST_TASK_S");
  add_number("--slurm-poll-s", options.poll_s, 0.05, 3600,
             "Interval between two queries of Slurm's queue, in s", "RPSUP_SLURM_POLL_S");
  add_number("--slurm-grace-s", options.grace_s, 0, 3600,
             "Maximum delay until the files of an ended task appear in the folder, in s",
             "RPSUP_SLURM_GRACE_S");
}

jobs::cluster::Site make_site(const ClusterOptions& options) {
  jobs::cluster::Site site;
  if (options.folder.empty()) return site;
  const std::string folder = "--slurm-folder " + options.folder;
  if (!std::filesystem::path(options.folder).is_absolute())
    throw BadInput(folder + ": must be an absolute path, since nodes have other working folders");
  if (!std::filesystem::is_directory(options.folder))
    throw BadInput(folder + ": there is no such folder; create it where all nodes see it");
  if (!options.program.empty() && !std::filesystem::is_regular_file(options.program)) {
    throw BadInput("--slurm-program " + options.program + ": there is no such file");
  }
  site.folder = options.folder;
  site.program = options.program;
  site.prefix = jobs::cluster::split_words(options.prefix);
  site.partition = options.partition;
  site.account = options.account;
  site.qos = options.qos;
  site.constraint = options.constraint;
  for (const std::string& option : options.options) {
    if (!option.starts_with('-')) {
      throw BadInput("--slurm-option " + option +
                     ": is no option of sbatch; one with a comma stands in quotes "
                     "in a configuration file");
    }
  }
  site.options = options.options;
  site.prologue = options.prologue;
  site.threads = options.threads;
  site.slots = options.slots;
  site.tasks = options.tasks;
  site.memory_mb = options.memory_mb;
  site.task_s = options.task_s;
  site.least_task_s = options.least_task_s;
  site.queue_poll = milliseconds(options.poll_s);
  // Reading the folder is cheaper than a query of the queue, which all users of a cluster share.
  constexpr double kFolderPollsPerQuery = 8.0;
  site.folder_poll = milliseconds(std::max(0.05, options.poll_s / kFolderPollsPerQuery));
  site.grace = milliseconds(options.grace_s);
  return site;
}

}  // namespace server::commands
