#include <cstdlib>
#include <string>

#include <CLI/CLI.hpp>

#include "jobs/parameter_help.h"
#include "server/commands/command.h"
#include "server/commands/serve.h"
#include "server/commands/simulate.h"
#include "server/commands/sweep.h"
#include "server/commands/validate.h"

namespace {

using server::commands::ServeOptions;
using server::commands::SimulateOptions;
using server::commands::SweepOptions;
using server::commands::ValidateOptions;

CLI::App* add_simulate(CLI::App& app, SimulateOptions& options) {
  CLI::App* const command = app.add_subcommand("simulate", "Compute one job and print it as JSON");
  command->add_option("file", options.file, "JSON file with the parameters; - reads standard input")->required();
  command->add_option("--trajectory", options.trajectory, "File for the trajectory, .csv or .json")
      ->envname("RPSUP_TRAJECTORY");
  command->add_option("--channels", options.channels, "Channels of the trajectory, with commas between; all if left out")
      ->delimiter(',')
      ->envname("RPSUP_CHANNELS");
  command->footer("Parameters, each with its default and what is allowed:\n" + jobs::parameter_help());
  return command;
}

void add_threads_option(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Jobs computed at a time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str()
      ->envname("RPSUP_THREADS");
}

void add_store_options(CLI::App& command, std::string& store, int& threads) {
  command.add_option("--db", store, "SQLite file that keeps sweeps and results; made if missing")
      ->required()
      ->envname("RPSUP_DB");
  add_threads_option(command, threads);
}

CLI::App* add_sweep(CLI::App& app, SweepOptions& options) {
  CLI::App* const command = app.add_subcommand("sweep", "Compute a sweep without a server");
  command->add_option("file", options.file, "JSON file with the sweep request; - reads standard input")->required();
  add_store_options(*command, options.store, options.threads);
  command->add_option("--results", options.results, "CSV file for the table of results; - writes standard output")
      ->capture_default_str()
      ->envname("RPSUP_RESULTS");
  return command;
}

CLI::App* add_serve(CLI::App& app, ServeOptions& options) {
  CLI::App* const command = app.add_subcommand("serve", "Run the service with its REST interface and its page");
  add_store_options(*command, options.store, options.threads);
  command->add_option("--host", options.host, "Address of the loopback to listen on")
      ->capture_default_str()
      ->envname("RPSUP_HOST");
  command->add_option("--port", options.port, "Port to listen on; 0 takes any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str()
      ->envname("RPSUP_PORT");
  command->add_option("--log-level", options.log_level, "What the log on standard error holds")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str()
      ->envname("RPSUP_LOG_LEVEL");
  return command;
}

CLI::App* add_validate(CLI::App& app, ValidateOptions& options) {
  CLI::App* const command = app.add_subcommand("validate", "Compare the engine with results that it did not compute itself");
  command->add_option("--report", options.report, "Markdown file for the report; figures go into validation/figures beside it")
      ->envname("RPSUP_REPORT");
  command->add_option("--check", options.check, "Report whose numbers must be those of this run")->envname("RPSUP_CHECK");
  command->add_option("--db", options.store, "SQLite file that keeps the study's jobs for the next time; a temporary one if left out")
      ->envname("RPSUP_STUDY_DB");
  add_threads_option(*command, options.threads);
  command->add_flag("--quick", options.quick, "Leave out the study and whatever else takes long")->envname("RPSUP_QUICK");
  return command;
}

void describe(CLI::App& app) {
  app.set_version_flag("--version", "rpsup " RPSUP_VERSION);
  // The library reads this file before the environment, so the name in the environment is its default.
  const char* const named = std::getenv("RPSUP_CONFIG");
  app.set_config("--config", named == nullptr ? "" : named,
                 "File with options: a [section] a command, a line name=value an option (Env:RPSUP_CONFIG)",
                 named != nullptr);
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.require_subcommand(1);
  app.fallthrough();
  app.footer(
      "Each option can also be given in the environment (see the names above) or in the --config file.\n"
      "Exit codes: 0 done, 1 a job (or a comparison) failed, 2 bad input, 3 the machine failed (disk, port, store in use), 130 interrupted.");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Parameter studies of the dynamics of the RPSUP spatial linkage", "rpsup"};
  describe(app);
  SimulateOptions simulate_options;
  SweepOptions sweep_options;
  ServeOptions serve_options;
  ValidateOptions validate_options;
  const CLI::App* const simulate = add_simulate(app, simulate_options);
  const CLI::App* const sweep = add_sweep(app, sweep_options);
  const CLI::App* const validate = add_validate(app, validate_options);
  add_serve(app, serve_options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? server::commands::kDone : server::commands::kBadInput;
  }
  return server::commands::run_guarded([&] {
    if (simulate->parsed()) return server::commands::simulate(simulate_options);
    if (sweep->parsed()) return server::commands::sweep(sweep_options);
    if (validate->parsed()) return server::commands::validate(validate_options);
    return server::commands::serve(serve_options);
  });
}
