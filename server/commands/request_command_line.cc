// SPDX-License-Identifier: Apache-2.0
#include "server/commands/request_command_line.h"

#include <array>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "server/commands/arguments.h"
#include "server/commands/command.h"
#include "server/commands/numerics.h"
#include "server/commands/output_format.h"
#include "server/commands/store_options.h"
#include "server/commands/study.h"

namespace server::commands {

namespace {

struct RequestCommand {
  const char* name;
  const char* help;
  Kind kind;
};

constexpr std::array<RequestCommand, 5> kRequestCommands{
    {{"sweep", "Compute a sweep", Kind::kSweep},
     {"search", "Look for the limit of a parameter: the last value before a metric first exceeds its bound",
      Kind::kSearch},
     {"wear", "Let the bearing wear over hours", Kind::kWearStudy},
     {"optimise", "Look for the parameters of the least or largest metrics", Kind::kOptimisation},
     {"fit", "Look for the parameters with which jobs give measured signals", Kind::kFit}}};

struct RequestOptions {
  SweepOptions sweep;
  std::string numerics = "native";
};

/// Decides between store and service: --db of the command line, then --url of it, then a store that the
/// environment or the configuration file names. @throws BadInput for options that exclude each other
void choose_place(const std::vector<std::string>& words, SweepOptions& options) {
  const bool store = is_given(words, "--db");
  const bool url = is_given(words, "--url");
  if (store && url)
    throw BadInput("--db and --url exclude each other: with --db the command computes, with --url a service");
  if (url) options.store.clear();
  if (!options.store.empty()) return;
  for (const char* const option : {"--threads", "--numerics"})
    if (is_given(words, option)) throw BadInput(std::string(option) + " needs --db: a service has its own");
}

Command add_request_command(CLI::App& app, const RequestCommand& info, char** argv) {
  const auto options = std::make_shared<RequestOptions>();
  const std::string noun(info_of(info.kind).noun);
  CLI::App* const command = app.add_subcommand(
      info.name, std::string(info.help) + ", with --db in this process, else by a running service");
  SweepOptions& sweep = options->sweep;
  command->add_option("file", sweep.file, "JSON file with the " + noun + " request; - reads standard input")
      ->required()
      ->type_name("FILE");
  add_store_option(*command, sweep.store,
                   "SQLite file of sweeps and results, created if missing: computes without a service");
  add_threads_option(*command, sweep.threads);
  add_remote_options(*command, sweep.remote);
  command
      ->add_option("--results", sweep.results,
                   "Results file: .json, .csv or .ndjson (a row a line); - writes standard output")
      ->type_name("FILE")
      ->capture_default_str()
      ->envname("RPSUP_RESULTS");
  add_format_option(*command, sweep.format, DataShape::kRows);
  add_numerics_option(*command, options->numerics);
  return {command, [options, kind = info.kind, argv] {
            std::vector<std::string> words;
            for (char** word = argv + 1; *word != nullptr; ++word) words.emplace_back(*word);
            choose_place(words, options->sweep);
            if (!options->sweep.store.empty()) enter_numerics(options->numerics, argv);
            return compute(kind, options->sweep);
          }};
}

}  // namespace

std::vector<Command> add_request_commands(CLI::App& app, char** argv) {
  std::vector<Command> commands;
  for (const RequestCommand& info : kRequestCommands)
    commands.push_back(add_request_command(app, info, argv));
  return commands;
}

}  // namespace server::commands
