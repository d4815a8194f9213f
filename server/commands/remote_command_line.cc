// SPDX-License-Identifier: Apache-2.0
#include "server/commands/remote_command_line.h"

#include <array>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "server/commands/option_table.h"
#include "server/commands/output_format.h"
#include "server/commands/remote_commands.h"
#include "server/commands/service_token.h"

namespace server::commands {

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

namespace {

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
  CLI::App* const command = add_command(
      app, "submit", "Submit a sweep, a job or a study to a running service and print its id", *options);
  command->add_option("file", options->file, "JSON file with the request; - reads standard input")
      ->required()
      ->type_name("FILE");
  command->add_option("--kind", options->kind, "Kind of the request")
      ->check(CLI::IsMember(words_of(kRunningKinds)))
      ->capture_default_str();
  command->add_flag("--job", options->job, "The same as --kind job: the file holds the parameters of one job")
      ->excludes("--kind");
  command->add_flag("--watch", options->watch, "Wait for the end, as rpsup watch does");
  return make_remote_command(command, options, submit);
}

/// Options on the columns of a file of measured signals.
void add_column_options(CLI::App& command, MeasureOptions& options) {
  command.add_option("--time", options.time,
                     "Column of the time in s; time_s, t_s or the first one if left out");
  command
      .add_option("--channel", options.channels,
                  "Column that is read, and channel of a trajectory that it measures, such as "
                  "acc=slider_acceleration_m_s2; may be repeated. Every column if left out")
      ->type_name("COLUMN=CHANNEL")
      ->allow_extra_args(false);
}

/// Adds the options that describe the sensors and the run.
void add_description_options(CLI::App& command, MeasureOptions& options) {
  command
      .add_option("--sensors", options.sensors,
                  "Corrections of sensors by channel, such as '{\"slider_acceleration_m_s2\": {\"sign\": "
                  "-1, \"gain\": 9.81, \"offset\": 0, \"delay_s\": 0.0002, \"low_pass_hz\": 2000}}'")
      ->type_name("JSON");
  command
      .add_option("--parameters", options.parameters,
                  "Parameters that are known of the run, such as '{\"crank_velocity_rad_s\": 10}'")
      ->type_name("JSON");
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
  add_column_options(*command, *options);
  add_description_options(*command, *options);
  return make_remote_command(command, options, measure);
}

/// The id of a resource, with the kinds that the command takes.
CLI::Option* add_id_option(CLI::App& command, std::string& id) {
  return command.add_option("id", id, "Id of a " + list_kinds(kinds_of_command(command.get_name())))
      ->type_name(kIdType);
}

CLI::Option* add_output_option(CLI::App& command, std::string& output, const char* help) {
  return command.add_option("--output", output, help)
      ->type_name("FILE")
      ->capture_default_str()
      ->envname("RPSUP_OUTPUT");
}

/// Adds the options that choose the listed resources if no id is given.
void add_list_options(CLI::App& command, CLI::Option* id, StatusOptions& options) {
  command.add_option("--kind", options.kind, "Kind of what is listed without an id")
      ->check(CLI::IsMember(words_of(kAllKinds)))
      ->capture_default_str()
      ->excludes(id);
  command.add_option("--state", options.state, "State of what is listed, such as failed; any if left out")
      ->excludes(id);
  command.add_option("--limit", options.limit, "Most lines of the list; 50 if left out")
      ->type_name("UINT")
      ->excludes(id);
}

void add_ids_option(CLI::App& command, StatusOptions& options) {
  std::vector<std::string> names;
  for (const IdCommand& each : kIdCommands) names.emplace_back(each.name);
  command
      .add_option("--ids", options.ids_for,
                  "Ids that a command takes, one a line, instead of a state; waits for 1 s at most, for the "
                  "completion of shells")
      ->check(CLI::IsMember(names))
      ->type_name("COMMAND");
}

Command add_status(CLI::App& app) {
  const auto options = std::make_shared<StatusOptions>();
  CLI::App* const command = add_command(
      app, "status",
      "Print the state of a sweep, a job, a study or a measurement, or list the newest of a kind", *options);
  CLI::Option* const id = add_id_option(*command, options->id);
  add_list_options(*command, id, *options);
  command->add_flag("--json", options->json, "JSON of the service instead of text");
  add_ids_option(*command, *options);
  return make_remote_command(command, options, status);
}

Command add_watch(CLI::App& app) {
  const auto options = std::make_shared<WatchOptions>();
  CLI::App* const command = add_command(
      app, "watch", "Show the progress of a sweep, a job or a study until it has ended", *options);
  add_id_option(*command, options->id)->required();
  return make_remote_command(command, options, watch);
}

/// Options on the columns, rows and order of a printed table.
void add_row_options(CLI::App& command, ResultsOptions& options) {
  command.add_option("--fields", options.fields,
                     "Columns in this order, separated by commas; all if left out");
  command
      .add_option("--where", options.where,
                  "Condition on the rows: a column, one of = < > <= >= and a value; may be repeated, and all "
                  "must hold")
      ->type_name("COLUMN=VALUE")
      ->allow_extra_args(false);
  command.add_option("--order-by", options.order_by,
                     "Columns by which the rows are ordered, separated by commas; --order-by=-COLUMN puts "
                     "the largest first");
  command.add_option("--limit", options.limit, "Most rows; all if left out")->type_name("UINT");
}

Command add_results(CLI::App& app) {
  const auto options = std::make_shared<ResultsOptions>();
  CLI::App* const command = add_command(
      app, "results", "Print the table of results of a sweep or a study, also while it runs", *options);
  add_id_option(*command, options->id)->required();
  add_format_option(*command, options->format, DataShape::kRows);
  add_output_option(*command, options->output,
                    "Output file: .json, .csv or .ndjson; - writes standard output");
  add_row_options(*command, *options);
  command->add_option("--metric", options->metric, "Metric of the statistics of replicates, of a sweep");
  return make_remote_command(command, options, results);
}

/// Adds the options that choose the printed samples of a trajectory or a measurement.
void add_sample_options(CLI::App& command, TrajectoryOptions& options) {
  command.add_option("--from", options.from, "Begin in s")->type_name("FLOAT");
  command.add_option("--to", options.to, "End in s")->type_name("FLOAT");
  command
      .add_option("--points", options.points,
                  "Most samples: each stretch of time keeps those at which a channel is smallest and largest")
      ->type_name("UINT");
  command.add_option("--run", options.run, "Run of a measurement; the first if left out")->type_name("UINT");
}

Command add_trajectory(CLI::App& app) {
  const auto options = std::make_shared<TrajectoryOptions>();
  CLI::App* const command = add_command(
      app, "trajectory",
      "Print the channels of a job or a measurement over time, or save those of all jobs of a sweep",
      *options);
  add_id_option(*command, options->id)->required();
  command->add_option("--channels", options->channels, "Channels, separated by commas; all if left out")
      ->envname("RPSUP_CHANNELS");
  add_sample_options(*command, *options);
  add_format_option(*command, options->format, DataShape::kColumns);
  add_output_option(*command, options->output,
                    "Output file: .json, .csv or .npz, and .h5, .mat or .npz of a sweep; - writes standard "
                    "output");
  return make_remote_command(command, options, trajectory);
}

Command add_report(CLI::App& app) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* const command = add_command(
      app, "report", "Save the report of a sweep, an HTML page that needs no other file", *options);
  add_id_option(*command, options->id)->required();
  add_output_option(*command, options->output, "Output file: .html; - writes standard output");
  command->add_option("--metric", options->metric, "Metric of the page; that of the service if left out");
  command->add_option("--x", options->x, "Number along the charts; the first that is swept if left out");
  command->add_flag("--rows", options->rows, "List all jobs in an appendix");
  return make_remote_command(command, options, save_report);
}

Command add_extend(CLI::App& app) {
  const auto options = std::make_shared<ExtendOptions>();
  CLI::App* const command =
      add_command(app, "extend", "Add values to the axes of a sweep, or cases; only new jobs run", *options);
  add_id_option(*command, options->id)->required();
  command->add_option("file", options->file, "JSON file with the extension; - reads standard input")
      ->required()
      ->type_name("FILE");
  command->add_flag("--watch", options->watch, "Wait for the end, as rpsup watch does");
  return make_remote_command(command, options, extend);
}

struct ChangeCommand {
  const char* name;
  const char* help;
  int (*run)(const ChangeOptions&);
};

constexpr std::array<ChangeCommand, 5> kChangeCommands{
    {{"open", "Print the links of pages of the dashboard", open},
     {"cancel", "Cancel sweeps, jobs or studies that have not ended", cancel},
     {"retry", "Queue the failed and cancelled jobs of sweeps or studies again", retry},
     {"move", "Give the queued jobs of sweeps to another executor", move},
     {"delete", "Delete sweeps, jobs, studies or measurements, with the results that nothing else shares",
      erase}}};

Command add_change(CLI::App& app, const ChangeCommand& info) {
  const auto options = std::make_shared<ChangeOptions>();
  CLI::App* const command = add_command(app, info.name, info.help, *options);
  command->add_option("id", options->ids, "Ids, each of a " + list_kinds(kinds_of_command(info.name)))
      ->required()
      ->type_name(kIdType);
  if (info.run == move) {
    command->add_option("--executor", options->executor, "Executor that computes the jobs from now on")
        ->check(CLI::IsMember({"local", "slurm"}))
        ->required();
  }
  return make_remote_command(command, options, info.run);
}

}  // namespace

std::vector<Command> add_remote_commands(CLI::App& app) {
  std::vector<Command> commands{add_submit(app),  add_measure(app),    add_status(app), add_watch(app),
                                add_results(app), add_trajectory(app), add_report(app), add_extend(app)};
  for (const ChangeCommand& info : kChangeCommands) commands.push_back(add_change(app, info));
  return commands;
}

}  // namespace server::commands
