// SPDX-License-Identifier: Apache-2.0
#include "server/commands/command_line.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "jobs/base/program_info.h"
#include "jobs/requests/parameter_help.h"
#include "server/commands/arguments.h"
#include "server/commands/check_cluster.h"
#include "server/commands/cluster_options.h"
#include "server/commands/command.h"
#include "server/commands/completion.h"
#include "server/commands/config_file.h"
#include "server/commands/export.h"
#include "server/commands/man_page.h"
#include "server/commands/numerics.h"
#include "server/commands/option_table.h"
#include "server/commands/output_check.h"
#include "server/commands/output_format.h"
#include "server/commands/paper.h"
#include "server/commands/remote_command_line.h"
#include "server/commands/request_command_line.h"
#include "server/commands/run_task.h"
#include "server/commands/serve.h"
#include "server/commands/service_token.h"
#include "server/commands/simulate.h"
#include "server/commands/store_options.h"
#include "server/commands/validate.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

void add_trajectory_options(CLI::App& command, SimulateOptions& options) {
  command.add_option("--trajectory", options.trajectory, "Trajectory file: .json, .csv or .npz")
      ->type_name("FILE")
      ->envname("RPSUP_TRAJECTORY");
  add_format_option(command, options.format, DataShape::kColumns);
  command
      .add_option("--channels", options.channels,
                  "Channels of the trajectory, separated by commas; all if left out")
      ->delimiter(',')
      ->envname("RPSUP_CHANNELS");
}

CLI::App* add_simulate(CLI::App& app, SimulateOptions& options) {
  CLI::App* const command = app.add_subcommand("simulate", "Compute one job and print it as JSON");
  command->add_option("file", options.file, "JSON file with the parameters; - reads standard input")
      ->required()
      ->type_name("FILE");
  add_trajectory_options(*command, options);
  command
      ->add_option("--plot", options.plot,
                   "Plot of the slider's acceleration, a file that ends in .svg; without a name, or with -, "
                   "drawn on the terminal (standard error)")
      ->expected(0, 1)
      ->type_name("FILE.svg")
      ->envname("RPSUP_PLOT");
  command->footer("Parameters, each with its default and what is allowed:\n" + jobs::parameter_help());
  return command;
}

/// Limits of jobs and of the store. 0 is no limit.
void add_limit_options(CLI::App& command, ServeOptions& options) {
  const auto add = [&](const char* name, auto& value, double largest, const char* help,
                       const char* variable) {
    command.add_option(name, value, help)
        ->check(CLI::Range(0.0, largest))
        ->capture_default_str()
        ->envname(variable);
  };
  add("--job-time-s", options.job_time_s, 1e9,
      "Maximum time of a job, after which it fails, in s; 0: no limit", "RPSUP_JOB_TIME_S");
  add("--job-steps", options.job_steps, 1e15,
      "Maximum number of steps of a job, after which it fails; 0: 100,000,000, the limit of every job",
      "RPSUP_JOB_STEPS");
  add("--job-memory-mb", options.job_memory_mb, 1e9,
      "Maximum memory of a job's trajectory, in MB; 0: no limit. Default: 1024, or less if the memory limit "
      "of the service's control group leaves less for each of its threads", "RPSUP_JOB_MEMORY_MB");
  add("--store-limit-mb", options.store_limit_mb, 1e9,
      "Maximum size of the store without its log, which takes up to 67 MB, in MB; 0: the space on its disk",
      "RPSUP_STORE_LIMIT_MB");
  add("--disk-reserve-mb", options.disk_reserve_mb, 1e9,
      "Minimum free space on the store's disk, in MB: with less, new sweeps and jobs are refused; 0: none",
      "RPSUP_DISK_RESERVE_MB");
}

CLI::App* add_serve(CLI::App& app, ServeOptions& options) {
  CLI::App* const command =
      app.add_subcommand("serve", "Run the service with its REST interface and its page");
  add_store_option(*command, options.store, "SQLite file of sweeps and results; created if missing")
      ->required();
  add_threads_option(*command, options.threads);
  command
      ->add_option("--host", options.host, "IP address to listen on; all but loopback addresses need a token")
      ->capture_default_str()
      ->envname("RPSUP_HOST");
  command->add_option("--port", options.port, "Port to listen on; 0: any free port")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str()
      ->envname("RPSUP_PORT");
  command
      ->add_option("--cors-origin", options.cors_origins,
                   "Allowed origins: other sites whose pages may use the service, as "
                   "https://lab.example.org, separated by commas")
      ->delimiter(',')
      ->envname("RPSUP_CORS_ORIGIN");
  command
      ->add_option("--name", options.names,
                   "Additional host names under which clients reach the service, as rpsup.example.org, "
                   "separated by commas")
      ->delimiter(',')
      ->envname("RPSUP_NAME");
  command
      ->add_option("--base-path", options.base_path,
                   "Path under which a proxy shows the service, as /rpsup, for links and Location; a proxy "
                   "that sends X-Forwarded-Prefix needs none")
      ->type_name("PATH")
      ->envname("RPSUP_BASE_PATH");
  command
      ->add_option("--token-file", options.token_file,
                   "Token file, readable by its owner only: the token that clients must send; RPSUP_TOKEN in "
                   "the environment if left out")
      ->check(describe_file_name_fault)
      ->type_name("FILE")
      ->envname("RPSUP_TOKEN_FILE");
  add_limit_options(*command, options);
  command->add_option("--executor", options.executor, "Default executor, for sweeps that name none")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str()
      ->envname("RPSUP_EXECUTOR");
  add_cluster_options(*command, options.cluster);
  command
      ->add_option("--log-level", options.log_level,
                   "Log level: least severe messages written to standard error")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str()
      ->envname("RPSUP_LOG_LEVEL");
  return command;
}

/// Entry for help and completion only: rpsup-validate reads the arguments of this command.
void add_validate(CLI::App& app) {
  app.add_subcommand("validate", "Run rpsup-validate, which compares the engine with independent results");
}

CLI::App* add_paper(CLI::App& app, PaperOptions& options) {
  CLI::App* const command =
      app.add_subcommand("paper", "Compare the results of a sweep with the statements of the paper");
  command
      ->add_option("files", options.files,
                   "JSON files with results, as rpsup sweep FILE --results NAME.json writes them, combined; "
                   "- reads standard input")
      ->required()
      ->type_name("FILE");
  return command;
}

void add_export_options(CLI::App& command, ExportOptions& options) {
  CLI::Option* const sweep =
      command
          .add_option("--trajectories", options.sweep,
                      "Sweep whose results and trajectories are written instead of a copy: .h5, .mat or "
                      ".npz. The store must not be in use; with a running service, use rpsup trajectory")
          ->type_name("SWEEP");
  command.add_option("--channels", options.channels, "Channels, separated by commas; all if left out")
      ->envname("RPSUP_CHANNELS");
  command.add_option("--from", options.from, "Begin of the trajectories in s")->needs(sweep);
  command.add_option("--to", options.to, "End of the trajectories in s")->needs(sweep);
  add_format_option(command, options.format, DataShape::kTrajectories);
}

CLI::App* add_export(CLI::App& app, ExportOptions& options) {
  CLI::App* const command =
      app.add_subcommand("export", "Write a consistent copy of a store, even while a service uses it, or the "
                                   "trajectories of a sweep");
  command
      ->add_option("file", options.file, "SQLite file for the copy, or file of trajectories; must not exist")
      ->required()
      ->check(describe_store_name_fault)
      ->type_name("FILE");
  add_store_option(*command, options.store, "SQLite file of sweeps and results")->required();
  add_export_options(*command, options);
  return command;
}

CLI::App* add_check_cluster(CLI::App& app, CheckClusterOptions& options) {
  CLI::App* const command = app.add_subcommand(
      "check-cluster", "Test a Slurm cluster as the service would use it, and report what is wrong");
  add_cluster_options(*command, options.cluster);
  command->add_option("--wait-s", options.wait_s, "Maximum time until a node has computed a job, in s")
      ->check(CLI::Range(1, 86'400))
      ->capture_default_str()
      ->envname("RPSUP_WAIT_S");
  return command;
}

CLI::App* add_run_task(CLI::App& app, RunTaskOptions& options) {
  CLI::App* const command = app.add_subcommand(
      "run-task",
      "Compute one task of a sweep on a node of a cluster; the service starts this command through Slurm");
  command->add_option("folder", options.folder, "Folder of the batch")->required()->type_name("FOLDER");
  command->add_option("generation", options.generation, "Array generation of the task")
      ->required()
      ->check(CLI::Range(0, 1'000'000));
  command
      ->add_option("--index", options.index,
                   "Index of the task in its array; SLURM_ARRAY_TASK_ID if left out")
      ->check(CLI::Range(0, 100'000'000));
  command
      ->add_option("--threads", options.threads,
                   "Jobs computed at a time; SLURM_CPUS_PER_TASK or 1 if left out")
      ->check(CLI::Range(1, 256));
  return command;
}

CLI::App* add_completion(CLI::App& app, std::string& shell) {
  CLI::App* const command = app.add_subcommand("completion", "Print the completion script of a shell");
  command->add_option("shell", shell, "Shell that reads the script")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  return command;
}

int print_completion(const CLI::App& app, const std::string& shell) {
  const auto commands = describe_commands(app);
  write_text("-", shell == "bash"  ? make_bash_completion(commands)
                                    : shell == "zsh" ? make_zsh_completion(commands)
                                                     : make_fish_completion(commands));
  return kDone;
}

/// Hides the value of --token in the list of processes, which every user can read.
void hide_token(int argc, char** argv) {
  constexpr std::string_view kOption = "--token";
  bool found = false;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    char* const value = argument.starts_with("--token=")          ? argv[i] + kOption.size() + 1
                        : argument == kOption && i + 1 < argc ? argv[i + 1]
                                                              : nullptr;
    if (value == nullptr) continue;
    std::fill_n(value, std::strlen(value), 'x');
    found = true;
  }
  if (found)
    std::cerr << "rpsup: --token shows the token to other users for a moment; give it by --token-file, "
                 "RPSUP_TOKEN or the configuration file\n";
}

int print_man_page(const CLI::App& app) {
  write_text("-", make_man_page(describe_commands(app),
                                                                    std::string(jobs::kProgramVersion)));
  return kDone;
}

/// Message on an option that a command does not have. False if something else was not expected.
bool tell_unknown_option(const CLI::App& app) {
  for (const std::string& word : app.remaining(true)) {
    if (!word.starts_with("--")) continue;
    std::cerr << "rpsup: " << terminal_text(describe_unknown_option(app, word)) << '\n';
    return true;
  }
  return false;
}

void add_config_option(CLI::App& app) {
  // The library reads this file before the environment, so the name in the environment is its default.
  const char* const named = std::getenv("RPSUP_CONFIG");
  app.set_config("--config", named == nullptr ? find_user_config() : named,
                 "Configuration file: a [section] for each command, a line name=value for each option; url "
                 "and token may stand above the sections. Default: rpsup/config.ini in $XDG_CONFIG_HOME "
                 "(~/.config) if it exists (Env:RPSUP_CONFIG)",
                 named != nullptr)
      ->check(describe_config_file_fault)
      ->type_name("FILE");
  app.allow_config_extras(CLI::config_extras_mode::error);
}

/// @param remote  commands that speak to a service
void describe(CLI::App& app, const std::vector<Command>& remote) {
  app.set_version_flag("--version", "rpsup " + std::string(jobs::kProgramVersionText),
                       "Print the version and exit");
  std::vector<std::string> remote_names;
  for (const Command& command : remote) remote_names.push_back(command.line->get_name());
  app.config_formatter(std::make_shared<ConfigFile>(app, std::move(remote_names)));
  add_config_option(app);
  app.require_subcommand(1);
  app.footer(
      "An option that shows (Env:NAME) can also be set in the environment. The --config file takes options "
      "without their dashes. The command line takes precedence over the environment, and the environment "
      "over the file.\n"
      "Exit codes: 0 done, 1 a job (or a comparison) failed, 2 bad input, 3 the machine or the network "
      "failed (disk, port, store in use, service not reached), 130 interrupted.");
}

}  // namespace

int run_command_line(int argc, char** argv) {
  // Writing beyond the limit of file sizes then fails with EFBIG instead of ending the program.
  std::signal(SIGXFSZ, SIG_IGN);
  if (argc > 1 && std::string_view(argv[1]) == "validate")
    return run_guarded([&]() -> int {
      run_validate({argv + 2, argv + argc});
    });
  CLI::App app{"Parameter studies of the dynamics of the RPSUP spatial linkage", "rpsup"};
  app.fallthrough();  // before the commands, which take it over
  SimulateOptions simulate_options;
  ServeOptions serve_options;
  PaperOptions paper_options;
  ExportOptions export_options;
  RunTaskOptions run_task_options;
  CheckClusterOptions check_options;
  std::string numerics = "native";
  std::string shell;
  std::vector<Command> commands = add_remote_commands(app);
  std::ranges::move(add_request_commands(app, argv), std::back_inserter(commands));
  describe(app, commands);
  commands.push_back({add_simulate(app, simulate_options), [&] { return simulate(simulate_options); }});
  add_validate(app);
  commands.push_back({add_paper(app, paper_options), [&] { return hold_against_paper(paper_options); }});
  commands.push_back({add_serve(app, serve_options), [&] { return serve(serve_options); }});
  commands.push_back({add_export(app, export_options), [&] { return export_store(export_options); }});
  commands.push_back({add_check_cluster(app, check_options), [&] { return check_cluster(check_options); }});
  commands.push_back({add_run_task(app, run_task_options), [&] { return run_task(run_task_options); }});
  commands.push_back({add_completion(app, shell), [&] { return print_completion(app, shell); }});
  commands.push_back({app.add_subcommand("man", "Print the manual page: rpsup man | man -l -"),
                      [&] { return print_man_page(app); }});
  for (const char* const name : {"simulate", "serve", "check-cluster"})
    add_numerics_option(*app.get_subcommand(name), numerics);
  try {
    std::vector<std::string> arguments = arrange_arguments(app, {argv + 1, argv + argc});
    hide_token(argc, argv);
    std::ranges::reverse(arguments);  // as the parser takes them
    app.parse(std::move(arguments));
  } catch (const BadInput& error) {
    return run_guarded([&]() -> int { throw error; });
  } catch (const CLI::ParseError& error) {
    if (tell_unknown_option(app)) return kBadInput;
    return run_guarded([&]() -> int {
      if (error.get_exit_code() != 0) check_environment(app);
      const bool is_help = app.exit(error) == 0;
      if (is_help) check_standard_output();
      return is_help ? kDone : kBadInput;
    });
  }
  const auto parsed =
      std::ranges::find_if(commands, [](const Command& command) { return command.line->parsed(); });
  return run_guarded([&] {
    if (parsed == commands.end())
      throw BadInput("validate must be the first word: rpsup-validate reads the others");
    check_environment(app);
    check_outputs(app, *parsed->line);
    check_processor();
    enter_numerics(numerics, argv);
    return parsed->run();
  });
}

}  // namespace server::commands
