// SPDX-License-Identifier: Apache-2.0
#include "server/commands/completion.h"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "server/commands/man_page.h"

namespace {

using namespace server::commands;

/// A program with one option of each kind.
std::vector<CommandEntry> commands() {
  CLI::App app{"Tests", "program"};
  CLI::App* const command = app.add_subcommand("go", "It's gone");
  std::string text;
  int number = 3;
  std::vector<std::string> list;
  bool flag = false;
  command->add_option("file", text, "What: [x]")->required()->type_name("FILE");
  command->add_option("--number", number, "How many")
      ->check(CLI::Range(1, 9))
      ->capture_default_str()
      ->envname("NUMBER");
  command->add_option("--word", text, "Which")->check(CLI::IsMember({"a", "b"}));
  command->add_option("--maybe", text, "Perhaps")->expected(0, 1);
  command->add_flag("--flag", flag, "Whether");
  command->add_option("rest", list, "More");
  return describe_commands(app);
}

const OptionEntry& option(const std::vector<CommandEntry>& all, const std::string& name) {
  for (const OptionEntry& entry : all.at(1).options) {
    if (entry.name == name) return entry;
  }
  throw std::runtime_error("no option " + name);
}

TEST(OptionTable, SaysWhatWasDeclared) {
  const auto all = commands();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "program");
  EXPECT_EQ(all[1].help, "It's gone");
  const OptionEntry number = option(all, "--number");
  EXPECT_EQ(number.value, "INT");
  EXPECT_EQ(number.allowed, "[1 - 9]");
  EXPECT_EQ(number.default_text, "3");
  EXPECT_EQ(number.environment, "NUMBER");
  EXPECT_EQ(option(all, "--word").choices, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(option(all, "--maybe").optional_value);
  EXPECT_EQ(option(all, "--flag").value, "");
  EXPECT_TRUE(option(all, "file").argument);
  EXPECT_TRUE(option(all, "file").required);
  EXPECT_TRUE(option(all, "rest").many);
  EXPECT_EQ(synopsis("program", all[1]), "program go [OPTIONS] file [rest...]");
}

TEST(ManPage, KeepsTheSignsOfRoffOutOfTheText) {
  const std::string page = make_man_page(
      {{.name = "p", .help = "a\\b", .footer = ".line\n'other\nplain-text", .options = {}}}, "1.0");
  EXPECT_NE(page.find("a\\eb"), std::string::npos);
  EXPECT_NE(page.find("\n\\&.line\n"), std::string::npos) << page;
  EXPECT_NE(page.find("\n\\&'other\n"), std::string::npos) << page;
  EXPECT_NE(page.find("\nplain\\-text\n"), std::string::npos) << page;
}

TEST(Completion, QuotesWhatShellsWouldRead) {
  EXPECT_NE(make_fish_completion(commands()).find(R"(-a go -d 'It'\''s gone')"), std::string::npos);
  EXPECT_NE(make_zsh_completion(commands()).find(R"('--word[Which]:TEXT:(a b)')"), std::string::npos);
  CommandEntry odd{.name = "odd",
                   .help = "",
                   .footer = "",
                   .options = {{.name = "--x",
                                .value = "",
                                .allowed = "",
                                .choices = {},
                                .help = "a[b]:c",
                                .default_text = "",
                                .environment = ""}}};
  EXPECT_NE(make_zsh_completion({commands()[0], odd}).find(R"('--x[a\[b\]\:c]')"), std::string::npos);
}

}  // namespace
