// SPDX-License-Identifier: Apache-2.0
#include "server/commands/arguments.h"

#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "server/commands/command.h"

namespace {

using server::commands::arrange_arguments;
using server::commands::BadInput;
using server::commands::describe_unknown_option;
using Words = std::vector<std::string>;

/// A program with an option of its own, and two commands.
struct Program {
  Program() {
    app.add_option("--config", text, "");
    CLI::App* const status = app.add_subcommand("status", "");
    status->add_option("--url", text, "");
    status->add_flag("--json", flag, "");
    status->add_option("id", list, "");
    CLI::App* const simulate = app.add_subcommand("simulate", "");
    simulate->add_option("--plot", text, "")->expected(0, 1);
    simulate->add_option("file", text, "");
  }
  CLI::App app{"", "program"};
  std::string text;
  Words list;
  bool flag = false;
};

TEST(Arguments, OfACommandMayStandBeforeIt) {
  const Program program;
  EXPECT_EQ(arrange_arguments(program.app, {"--url", "u", "--json", "--config", "c", "status", "a"}),
            (Words{"--config", "c", "status", "a", "--url", "u", "--json"}));
  EXPECT_EQ(arrange_arguments(program.app, {"--url=u", "status", "--", "--a"}),
            (Words{"status", "--url=u", "--", "--a"}));
  EXPECT_EQ(arrange_arguments(program.app, {"status", "--url", "u"}), (Words{"status", "--url", "u"}));
  EXPECT_EQ(arrange_arguments(program.app, {"--url"}), (Words{"--url"}));
  EXPECT_EQ(arrange_arguments(program.app, {}), Words{});
}

TEST(Arguments, OfPlotAreNamesOfPicturesOnly) {
  const Program program;
  EXPECT_EQ(arrange_arguments(program.app, {"simulate", "--plot", "job.json"}),
            (Words{"simulate", "--plot=-", "job.json"}));
  EXPECT_EQ(arrange_arguments(program.app, {"--plot", "a.svg", "simulate", "job.json"}),
            (Words{"simulate", "job.json", "--plot=a.svg"}));
}

std::string refusal_of(const Words& words) {
  try {
    static_cast<void>(arrange_arguments(Program().app, words));
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

TEST(Arguments, NameTheCommandThatWasMeant) {
  EXPECT_EQ(refusal_of({"stauts"}), "there is no command stauts; did you mean status?");
  EXPECT_EQ(refusal_of({"--url", "u", "simulat"}), "there is no command simulat; did you mean simulate?");
  EXPECT_EQ(refusal_of({"nothing"}), "there is no command nothing; rpsup --help lists all");
}

TEST(Arguments, NameTheOptionThatWasMeant) {
  Program program;
  EXPECT_THROW(program.app.parse(std::vector<std::string>{"u", "--ulr", "status"}), CLI::ParseError);
  EXPECT_EQ(describe_unknown_option(program.app, "--ulr=u"),
            "there is no option --ulr of status; did you mean --url?");
  EXPECT_EQ(describe_unknown_option(program.app, "--nothing"),
            "there is no option --nothing of status; program status --help lists all");
}

TEST(Arguments, AreGivenInOneWordOrTwo) {
  using server::commands::is_given;
  EXPECT_TRUE(is_given({"a", "--db", "x"}, "--db"));
  EXPECT_TRUE(is_given({"--db=x"}, "--db"));
  EXPECT_FALSE(is_given({"--dbx", "x"}, "--db"));
}

// Newer parsers leave an option without a value where the environment has a wrong one.
TEST(Arguments, OfTheEnvironmentAreRefusedIfTheirOptionsDoNotTakeThem) {
  CLI::App app{"", "program"};
  int threads = 2;
  app.add_option("--threads", threads, "")->check(CLI::Range(1, 256))->envname("RPSUP_TEST_THREADS");
  ::setenv("RPSUP_TEST_THREADS", "300", 1);
  try {
    server::commands::check_environment(app);
    ADD_FAILURE() << "300 threads are taken";
  } catch (const BadInput& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("--threads (RPSUP_TEST_THREADS): ")) << error.what();
  }
  for (const char* const value : {"3", ""}) {
    ::setenv("RPSUP_TEST_THREADS", value, 1);
    EXPECT_NO_THROW(server::commands::check_environment(app)) << value;
  }
  ::unsetenv("RPSUP_TEST_THREADS");
}

}  // namespace
