// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <string>

#include <CLI/CLI.hpp>

#include "jobs/base/program_info.h"
#include "server/commands/arguments.h"
#include "server/commands/command.h"
#include "server/commands/numerics.h"
#include "validation/program/validate.h"

namespace {

void add_options(CLI::App& app, validation::program::ValidateOptions& options) {
  app.add_option("--report", options.report,
                 "Markdown file for the report, with rows.csv and figures beside it")
      ->type_name("FILE")
      ->envname("RPSUP_REPORT");
  app.add_option("--check", options.check, "Report that must agree with this run, with rows.csv beside it")
      ->type_name("FILE")
      ->envname("RPSUP_CHECK");
  app.add_option("--db", options.store, "SQLite file for the jobs of the paper's sweep; a temporary one if left out")
      ->type_name("FILE")
      ->envname("RPSUP_STUDY_DB");
  app.add_option("--threads", options.threads, "Jobs computed at a time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str()
      ->envname("RPSUP_THREADS");
  app.add_flag("--quick", options.quick, "Only light parts: without the paper's sweep")->envname("RPSUP_QUICK");
  app.footer(
      "Exit codes: 0 all within their bounds, 1 a comparison failed or the report differs, 2 bad input, "
      "3 the machine failed, 130 interrupted.");
}

}  // namespace

int main(int argc, char** argv) {
  // A file that may not grow any more is an error to report, not the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{"Compare the engine with closed forms, published numbers and other codes", "rpsup-validate"};
  validation::program::ValidateOptions options;
  add_options(app, options);
  const std::string version = "rpsup-validate " + std::string(jobs::kProgramVersionText);
  app.set_version_flag("--version", version, "Print the version and exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? server::commands::kDone : server::commands::kBadInput;
  }
  return server::commands::run_guarded([&] {
    server::commands::check_environment(app);
    server::commands::check_processor();
    return validate(options);
  });
}
