// SPDX-License-Identifier: Apache-2.0
#include "server/commands/remote_command_line.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "server/commands/remote_commands.h"
#include "server/commands/service_token.h"

namespace server::commands {

namespace {

void add_remote_options(CLI::App& command, RemoteOptions& options) {
  command.add_option("--url", options.url, "URL of the service")
      ->type_name("URL")
      ->capture_default_str()
      ->envname("RPSUP_URL");
  command
      .add_option("--token-file", options.token_file,
                  "Token file, readable by its owner only: the token, sent as Authorization: Bearer; before "
                  "RPSUP_TOKEN in the environment and token in the configuration file")
      ->check(describe_file_name_fault)
      ->type_name("FILE")
      ->envname("RPSUP_TOKEN_FILE");
  command
      .add_option("--token", options.token,
                  "Token; for the environment and the configuration file, since other users see command "
                  "lines: there the program warns and hides the token")
      ->envname("RPSUP_TOKEN");
}

/// A command with the options that all of them have.
template <typename Options>
CLI::App* add_command(CLI::App& app, const char* name, const char* help, Options& options) {
  CLI::App* const command = app.add_subcommand(name, help);
  add_remote_options(*command, options.remote);
  return command;
}

/// @param options  shared with the command that they belong to
template <typename Options>
Command make_remote_command(CLI::App* line, std::shared_ptr<Options> options, int (*run)(const Options&)) {
  return {line, [options = std::move(options), run] { return run(*options); }};
}

Command add_submit(CLI::App& app) {
  const auto options = std::make_shared<SubmitOptions>();
  CLI::App* const command =
      add_command(app, "submit", "Submit a sweep to a running service and print its id", *options);
  command->add_option("file", options->file, "JSON file with the sweep request; - reads standard input")
      ->required()
      ->type_name("FILE");
  command->add_flag("--job", options->job,
                    "Job instead of a sweep: the file holds the parameters of one job");
  command->add_flag("--watch", options->watch, "Wait for the end, as rpsup watch does");
  return make_remote_command(command, options, submit);
}

Command add_measure(CLI::App& app) {
  const auto options = std::make_shared<MeasureOptions>();
  CLI::App* const command = add_command(
      app, "measure", "Store a file of measured signals in a running service and print its id", *options);
  command
      ->add_option("file", options->file,
                   "CSV file, whose first line names the columns; or one that ends in .npz or .json; - reads "
                   "CSV from standard input")
      ->required()
      ->type_name("FILE");
  command->add_option("--name", options->name, "Name of the measurement; that of the file if left out");
  command->add_option("--time", options->time,
                      "Column of the time in s; time_s, t_s or the first one if left out");
  command
      ->add_option("--channel", options->channels,
                   "Column that is read, and channel of a trajectory that it measures, such as "
                   "acc=slider_acceleration_m_s2; may be repeated. Every column if left out")
      ->type_name("COLUMN=CHANNEL")
      ->allow_extra_args(false);
  return make_remote_command(command, options, measure);
}

Command add_status(CLI::App& app) {
  const auto options = std::make_shared<StatusOptions>();
  CLI::App* const command = add_command(
      app, "status", "Print the progress of a sweep or a job, or list the newest sweeps", *options);
  command->add_option("id", options->id, "Id of a sweep or a job; if left out, the newest sweeps are listed");
  command->add_flag("--json", options->json, "JSON of the service instead of text");
  return make_remote_command(command, options, status);
}

Command add_watch(CLI::App& app) {
  const auto options = std::make_shared<WatchOptions>();
  CLI::App* const command =
      add_command(app, "watch", "Show the progress of a sweep or a job until it has ended", *options);
  command->add_option("id", options->id, "Id of a sweep or a job")->required();
  return make_remote_command(command, options, watch);
}

Command add_results(CLI::App& app) {
  const auto options = std::make_shared<ResultsOptions>();
  CLI::App* const command =
      add_command(app, "results", "Print the table of results of a sweep, also while it runs", *options);
  command->add_option("id", options->sweep, "Id of a sweep")->required();
  command->add_option("--format", options->format, "Format of the table")
      ->check(CLI::IsMember({"csv", "json", "ndjson"}))
      ->capture_default_str()
      ->envname("RPSUP_FORMAT");
  command->add_option("--output", options->output, "Output file; - writes standard output")
      ->type_name("FILE")
      ->capture_default_str()
      ->envname("RPSUP_OUTPUT");
  return make_remote_command(command, options, results);
}

Command add_cancel(CLI::App& app) {
  const auto options = std::make_shared<CancelOptions>();
  CLI::App* const command = add_command(app, "cancel", "Cancel sweeps or jobs that have not ended", *options);
  command->add_option("id", options->ids, "Ids of sweeps or jobs")->required();
  return make_remote_command(command, options, cancel);
}

}  // namespace

std::vector<Command> add_remote_commands(CLI::App& app) {
  return {add_submit(app), add_measure(app), add_status(app),
          add_watch(app),  add_results(app), add_cancel(app)};
}

}  // namespace server::commands
